import threading

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.lock = threading.Lock()
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.send)

    def send(self):
        with self.lock:
            command = Twist()
            command.linear.x = 2.0
            command.angular.z = 1.0
            self.publisher.publish(command)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    executor = MultiThreadedExecutor(2)
    executor.add_node(node)
    spinner = threading.Thread(target=executor.spin, daemon=True)
    spinner.start()
    done = threading.Event()
    rclpy.get_default_context().on_shutdown(done.set)
    try:
        while not done.wait(timeout=0.5):
            pass
    except KeyboardInterrupt:
        pass
    executor.shutdown()
    spinner.join()
    node.destroy_node()
    rclpy.try_shutdown()
