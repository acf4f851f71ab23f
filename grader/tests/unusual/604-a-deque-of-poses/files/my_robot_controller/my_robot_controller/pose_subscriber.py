import collections
import math
import string

import rclpy
import rclpy.node
import turtlesim.msg

LINE = string.Template("x=$x y=$y distance=$d")


class PoseSubscriber(rclpy.node.Node):
    def __init__(self):
        super().__init__("pose_subscriber")
        self.poses = collections.deque(maxlen=2)
        self.steps = []
        self.sub = self.create_subscription(turtlesim.msg.Pose, "turtle1/pose", self.poses_append, 1)
        self.timer = None

    def poses_append(self, pose):
        self.poses.append(pose)
        if len(self.poses) == 2:
            a, b = self.poses
            self.steps.append(math.sqrt((a.x - b.x) ** 2 + (a.y - b.y) ** 2))
        if self.timer is None:
            self.timer = self.create_timer(1.0, self.log)

    def log(self):
        *_, here = self.poses
        numbers = dict(x=here.x, y=here.y, d=math.fsum(self.steps))
        self.get_logger().info(LINE.substitute({key: f"{value:.2f}" for key, value in numbers.items()}))


def main(args=None):
    rclpy.init(args=args)
    node = PoseSubscriber()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
