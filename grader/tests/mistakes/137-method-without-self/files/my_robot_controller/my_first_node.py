import rclpy
from rclpy.node import Node

class Ticker(Node):
    def __init__(self):
        super().__init__('first_node')
        self.n = 0
        self.t = self.create_timer(1.0, self.tick)

    def tick():
        self.get_logger().info('Hello ' + str(self.n))
        self.n += 1

def main():
    rclpy.init()
    rclpy.spin(Ticker())
