#!/usr/bin/python
import rclpy
from rclpy.node import Node

class FirstNode(Node):
    def __init__(self):
        super().__init__('first_node')
        self.counter = 0
        timer = self.create_timer(1.0, self.timer_callback)

    def timer_callback(self):
        self.get_logger().info('Hello %d' % self.counter)
        self.counter += 1

def main(args=None):
    rclpy.init(args=args)
    first_node = FirstNode()
    rclpy.spin(first_node)
    first_node.destroy_node
    rclpy.shutdown

if __name__ == '__main__':
    main()
