import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.parameter import Parameter


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle", parameter_overrides=[Parameter("use_sim_time", value=False)])
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.drive)

    def drive(self):
        twist = Twist()
        twist.linear.x = 2.0
        twist.angular.z = 1.0
        self.publisher.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(DrawCircle())
    except KeyboardInterrupt:
        pass
