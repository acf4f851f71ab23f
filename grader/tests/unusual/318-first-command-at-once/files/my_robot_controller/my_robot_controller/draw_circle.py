import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.message = Twist()
        self.message.linear.x = 2.0
        self.message.angular.z = 1.0
        self.publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.publish_again()
        self.timer = self.create_timer(0.5, self.publish_again)

    def publish_again(self):
        self.publisher.publish(self.message)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException) as exception:
        node.get_logger().error(repr(exception))
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
