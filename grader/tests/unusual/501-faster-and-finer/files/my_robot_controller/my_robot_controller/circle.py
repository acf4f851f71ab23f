from geometry_msgs.msg import Twist
import rclpy
from rclpy.node import Node


class Circle(Node):
    RADIUS = 1.5
    TURNING = 2.0

    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.drive)

    def drive(self):
        twist = Twist()
        twist.linear.x = self.RADIUS * self.TURNING
        twist.angular.z = self.TURNING
        self.publisher.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Circle())
