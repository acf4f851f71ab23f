import math
from dataclasses import dataclass, field

import rclpy
from rclpy.serialization import deserialize_message
from turtlesim.msg import Pose


@dataclass
class Way:
    points: list = field(default_factory=list)
    driven: float = 0.0

    def hear(self, data: bytes) -> None:
        pose = deserialize_message(data, Pose)
        self.points.append((pose.x, pose.y))

    def tell(self) -> str:
        self.driven += sum(math.dist(a, b) for a, b in zip(self.points, self.points[1:]))
        del self.points[:-1]
        (x, y), = self.points
        return "x=" + f"{x:.2f}" + " y=" + f"{y:.2f}" + " distance=" + f"{self.driven:.2f}"


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("pose_subscriber")
    way = Way()
    node.create_subscription(Pose, "/turtle1/pose", way.hear, 10, raw=True)
    node.create_timer(1.0, lambda: way.points and node.get_logger().info(way.tell()))
    rclpy.spin(node)
