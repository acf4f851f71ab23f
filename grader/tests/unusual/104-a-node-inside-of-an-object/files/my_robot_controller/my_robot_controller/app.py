from contextlib import ExitStack, suppress

import rclpy
from rclpy.executors import ExternalShutdownException


class App:
    def __init__(self):
        self.node = rclpy.create_node("first_node")
        self.log = self.node.get_logger()
        self.n = 0
        self.timer = None

    def start(self):
        if self.timer is not None:
            self.timer.cancel()
        self.timer = self.node.create_timer(1.0, lambda: self.tick())
        return self

    def tick(self):
        n, self.n = self.n, self.n + 1
        self.log.info("Hello {n}".format(n=n))

    @classmethod
    def run(cls):
        with ExitStack() as stack:
            rclpy.init()
            stack.callback(rclpy.try_shutdown)
            app = cls().start()
            stack.callback(app.node.destroy_node)
            with suppress(KeyboardInterrupt, ExternalShutdownException):
                rclpy.spin(app.node)
