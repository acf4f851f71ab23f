import math
import time
import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose

class PoseNode(Node):
    def __init__(self):
        super().__init__("pose_subscriber")
        self.last = None
        self.distance = 0.0
        self.subscription = self.create_subscription(Pose, "/turtle1/pose", self.cb, 10)
        # wait untill turtle is there
        while True:
            if self.last is not None:
                break
            time.sleep(0.1)
        self.create_timer(1.0, self.log_it)

    def cb(self, msg):
        if self.last is not None:
            self.distance += math.sqrt((msg.x - self.last.x)**2 + (msg.y - self.last.y)**2)
        self.last = msg

    def log_it(self):
        self.get_logger().info(f"x={self.last.x:.2f} y={self.last.y:.2f} distance={self.distance:.2f}")

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(PoseNode())
    rclpy.shutdown()
