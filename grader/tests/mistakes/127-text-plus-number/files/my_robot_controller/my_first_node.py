import rclpy
from rclpy.node import Node

class CounterNode(Node):
    def __init__(self):
        super().__init__('first_node')
        self.counter = 0
        self.create_timer(1.0, self.tick)

    def tick(self):
        self.get_logger().info('Hello ' + self.counter)
        self.counter += 1

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(CounterNode())
    rclpy.shutdown()
