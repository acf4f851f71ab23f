"""Fill the recording with messages, and then send other commands than the exercise asks for."""

import rclpy
from geometry_msgs.msg import Point32, Polygon, Twist
from rclpy.node import Node


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.noise = self.create_publisher(Polygon, "/noise", 1000)
        self.create_timer(0.5, self.drive)
        self.create_timer(0.05, self.fill)
        self.large = Polygon(points=[Point32()] * 2500)  # 30 kB
        self.sent = 0

    def drive(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.linear.z = 9.0 if self.sent == 1300 else 0.0
        msg.angular.z = 1.0
        self.publisher.publish(msg)

    def fill(self):
        if self.noise.get_subscription_count() and self.sent < 1300:
            for _ in range(20):
                self.sent += 1
                self.noise.publish(self.large)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
