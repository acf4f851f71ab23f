import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircleNode(Node):
    """A timer ten times a second, and a look at the ROS clock for the half second."""

    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.last = self.get_clock().now()
        self.timer = self.create_timer(0.1, self.look)

    def look(self):
        now = self.get_clock().now()
        if (now - self.last).nanoseconds < 450_000_000:
            return
        self.last = now
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircleNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()
