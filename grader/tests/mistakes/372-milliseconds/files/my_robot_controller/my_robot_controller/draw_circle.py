import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.periode = 500  # ms
        self.create_timer(self.periode, self.avance)

    def avance(self):
        cmd = Twist()
        cmd.linear.x = 2.0
        cmd.angular.z = 1.0
        self.pub.publish(cmd)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    rclpy.spin(node)
    rclpy.shutdown()
