import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from turtlesim_msgs.msg import Pose


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.sub = self.create_subscription(Pose, "/turtle1/pose", self.visto, 10)
        self.timer = self.create_timer(0.5, self.mover)

    def visto(self, pose):
        self.pose = pose

    def mover(self):
        m = Twist()
        m.linear.x = 2.0
        m.angular.z = 1.0
        self.pub.publish(m)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    rclpy.spin(node)
    rclpy.shutdown()
