import rclpy
from rclpy.node import Node


class FirstNode(Node):

    def __init__(self):
        super().__init__('first_node')
        self.count_ = 0
        self.timer_ = self.create_timer(1.0, self.timer_cb)

    def timer_cb(self):
        self.get_logger().info("Hello", self.count_)
        self.count_ += 1


def main(args=None):
    rclpy.init(args=args)
    node = FirstNode()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()
