import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose, Twist


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_timer(0.5, self.move)

    def move(self):
        t = Twist()
        t.linear.x = 2.0
        t.angular.z = 1.0
        self.pub.publish(t)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    rclpy.spin(node)
    rclpy.shutdown()
