import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class Circle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.p = self.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.t = self.create_timer(0.5, self.cb)

    def cb(self):
        m = Twist()
        m.linear.x = 2.0
        m.angular.z = 1.0
        self.p.publish(m)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Circle())
