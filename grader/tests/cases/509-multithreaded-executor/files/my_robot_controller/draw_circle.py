import rclpy
from geometry_msgs.msg import Twist
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class DrawCircleNode(Node):
    def __init__(self):
        super().__init__("draw_circle")
        group = ReentrantCallbackGroup()
        self.pub = self.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.sent = 0
        self.timer = self.create_timer(0.5, self.send, callback_group=group)
        self.logging = self.create_timer(1.0, self.log, callback_group=group)

    def send(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.pub.publish(msg)
        self.sent += 1

    def log(self):
        self.get_logger().info(f"{self.sent} commands so far")


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircleNode()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
