import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircle(Node):
    def __init__(self, speed: float) -> None:
        super().__init__("draw_circle")
        self.speed = speed
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.drive)

    def drive(self) -> None:
        command = Twist()
        command.linear.x = self.speed
        command.angular.z = 1.0
        self.publisher.publish(command)


def main() -> None:
    speed = float(sys.argv[1]) if len(sys.argv) > 1 else 2.0
    rclpy.init(args=sys.argv)
    node = DrawCircle(speed)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.destroy_node()
    rclpy.try_shutdown()
