import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Robot(Node):
    """Knows nothing of turtles."""

    def __init__(self, **kwargs):
        super().__init__("robot", **kwargs)
        self.velocity = self.create_publisher(Twist, "cmd_vel", 10)
        self.clock = self.create_timer(0.5, self.drive)

    def drive(self):
        self.velocity.publish(COMMAND)


COMMAND = Twist()
COMMAND.linear.x = 2.
COMMAND.angular.z = 1.


def main(args=None):
    rclpy.init(args=args)
    robot = Robot(cli_args=["--ros-args", "-r", "cmd_vel:=/turtle1/cmd_vel", "-r", "__node:=draw_circle"])
    try:
        rclpy.spin(robot)
    except BaseException:
        rclpy.try_shutdown()
        raise
