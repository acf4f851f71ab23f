"""Both nodes of the package."""
import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class FirstNode(Node):
    def __init__(self):
        super().__init__("first_node")
        self.number = 0
        self.create_timer(1.0, self.say)

    def say(self):
        self.get_logger().info(f"Hello {self.number}")
        self.number += 1


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_timer(0.5, self.send)

    def send(self):
        twist = Twist()
        twist.linear.x = 2.0
        twist.angular.z = 1.0
        self.publisher.publish(twist)


def runner(node_class):
    def run(args=None):
        rclpy.init(args=args)
        try:
            rclpy.spin(node_class())
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        finally:
            rclpy.try_shutdown()

    return run


first = runner(FirstNode)
circle = runner(DrawCircle)
