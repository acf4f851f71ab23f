import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_timer(0.5, self.tick)

    def tick(self):
        cmd = Twist()
        cmd.linear.x = 2
        cmd.angular.z = 1
        self.pub.publish(cmd)


def main():
    rclpy.init()
    rclpy.spin(DrawCircle())
