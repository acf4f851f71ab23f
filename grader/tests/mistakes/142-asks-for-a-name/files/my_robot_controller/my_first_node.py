import rclpy
from rclpy.node import Node

class HelloNode(Node):
    def __init__(self):
        super().__init__("first_node")
        self.name = input("What is your name? ")
        self.counter = 0
        self.timer = self.create_timer(1.0, self.hello)

    def hello(self):
        self.get_logger().info(f"Hello {self.counter}")
        self.counter += 1

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(HelloNode())
    rclpy.shutdown()
