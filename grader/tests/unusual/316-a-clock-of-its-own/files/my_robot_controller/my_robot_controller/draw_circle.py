import rclpy
from geometry_msgs.msg import Twist
from rclpy.clock import Clock
from rclpy.node import Node
from turtlesim.msg import Pose

clock = Clock()


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.subscription = self.create_subscription(Pose, "/turtle1/pose", self.pose_received, 10)
        self.next_ns = clock.now().nanoseconds

    def pose_received(self, _):
        if clock.now().nanoseconds >= self.next_ns:
            self.next_ns = clock.now().nanoseconds + 500_000_000
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
