import math
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, DurabilityPolicy
from turtlesim.msg import Pose

class PoseSubscriber(Node):
    def __init__(self):
        super().__init__('pose_subscriber')
        qos = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.pose_ = None
        self.distance_ = 0.0
        self.sub_ = self.create_subscription(Pose, '/turtle1/pose', self.pose_cb, qos)
        self.timer_ = self.create_timer(1.0, self.timer_cb)

    def pose_cb(self, msg):
        if self.pose_ is not None:
            self.distance_ += math.hypot(msg.x - self.pose_.x, msg.y - self.pose_.y)
        self.pose_ = msg

    def timer_cb(self):
        if self.pose_ is None:
            return
        self.get_logger().info('x=%.2f y=%.2f distance=%.2f' % (self.pose_.x, self.pose_.y, self.distance_))

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(PoseSubscriber())
    rclpy.shutdown()
