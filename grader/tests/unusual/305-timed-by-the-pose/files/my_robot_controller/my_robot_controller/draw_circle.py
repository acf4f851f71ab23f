import rclpy
from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node
from turtlesim.msg import Pose

HALF_A_SECOND = Duration(seconds=0.5)


class DrawCircle(Node):
    def __init__(self):
        super().__init__('draw_circle')
        self.pub = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.sub = self.create_subscription(Pose, '/turtle1/pose', self.pose_callback, 10)
        self.due = self.get_clock().now()

    def pose_callback(self, pose: Pose):
        now = self.get_clock().now()
        if now < self.due:
            return
        self.due = now + HALF_A_SECOND
        self.get_logger().debug(f'at {pose.x:.1f} {pose.y:.1f}')
        self.drive()

    def drive(self):
        twist = Twist()
        twist.linear.x = 2.0
        twist.linear.y = 0.0
        twist.linear.z = 0.0
        twist.angular.x = 0.0
        twist.angular.y = 0.0
        twist.angular.z = 1.0
        self.pub.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.get_logger().info('Keyboard interrupt')
    finally:
        node.destroy_node()
        if rclpy.ok():
            rclpy.shutdown()
