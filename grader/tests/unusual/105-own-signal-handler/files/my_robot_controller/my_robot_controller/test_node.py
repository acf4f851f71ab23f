import signal
import sys

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions


class Stopper:
    def __init__(self):
        self.stopped = False
        signal.signal(signal.SIGINT, self)
        signal.signal(signal.SIGTERM, self)

    def __call__(self, number, frame):
        self.stopped = True


class Hello(Node):
    def __init__(self):
        super().__init__('first_node')
        self.i = -1
        self.timer = self.create_timer(1.0, self.hello)

    def hello(self):
        self.i += 1
        self.get_logger().info(f'Hello {self.i}')


def main(args=None):
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    stopper = Stopper()
    node = Hello()
    while not stopper.stopped:
        rclpy.spin_once(node, timeout_sec=0.05)
    node.get_logger().info('stopping')
    node.destroy_node()
    rclpy.shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
