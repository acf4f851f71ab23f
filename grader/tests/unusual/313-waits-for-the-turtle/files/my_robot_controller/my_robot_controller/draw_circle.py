import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle", allow_undeclared_parameters=True, automatically_declare_parameters_from_overrides=True)
        self._pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self._waiting = self.create_timer(0.1, self._look)
        self._driving = None

    def _look(self):
        if self.count_subscribers("/turtle1/cmd_vel") == 0:
            self.get_logger().info("waiting for a turtle", once=True)
            return
        self._waiting.cancel()
        self._driving = self.create_timer(0.5, self._drive)
        self._drive()

    def _drive(self):
        msg = Twist()
        setattr(msg.linear, "x", 2.0)
        setattr(msg.angular, "z", 1.0)
        self._pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        # stop the turtle before we go
        node._pub.publish(Twist())
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
