import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy, HistoryPolicy
from geometry_msgs.msg import Twist


class Circulo(Node):
    def __init__(self):
        super().__init__("draw_circle")
        perfil = QoSProfile(
            reliability=ReliabilityPolicy.BEST_EFFORT,
            history=HistoryPolicy.KEEP_LAST,
            depth=1,
        )
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", perfil)
        self.timer = self.create_timer(0.5, self.publicar)

    def publicar(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Circulo())
    rclpy.shutdown()
