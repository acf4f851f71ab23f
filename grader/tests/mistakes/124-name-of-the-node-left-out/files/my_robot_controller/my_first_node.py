import rclpy
from rclpy.node import Node

class HelloNode(Node):   # my 1st node!!
    def __init__(self):
        super().__init__()
        self.count = 0
        self.my_timer = self.create_timer(1.0, self.on_timer)
    def on_timer(self):
        self.get_logger().info('Hello {}'.format(self.count))
        self.count = self.count + 1

def main(args=None):
    rclpy.init(args=args)
    n = HelloNode()
    rclpy.spin(n)
    n.destroy_node()
    rclpy.shutdown()

if __name__ == '__main__':
    main()
