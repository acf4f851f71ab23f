from threading import Lock
from typing import NamedTuple, Optional

import numpy as np
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from turtlesim.msg import Pose


class Snapshot(NamedTuple):
    at: np.ndarray
    distance: float

    def __str__(self):
        return "x={:.2f} y={:.2f} distance={:.2f}".format(self.at[0], self.at[1], self.distance)


class PoseSubscriber(Node):
    def __init__(self):
        super().__init__("pose_subscriber")
        self._lock = Lock()
        self._snapshot: Optional[Snapshot] = None
        self._subscription = self.create_subscription(
            Pose, "/turtle1/pose", self._hear, 50, callback_group=MutuallyExclusiveCallbackGroup())
        self._timer = self.create_timer(1.0, self._tell, callback_group=MutuallyExclusiveCallbackGroup())

    def _hear(self, pose):
        here = np.array([pose.x, pose.y])
        with self._lock:
            old = self._snapshot
            way = 0.0 if old is None else old.distance + np.linalg.norm(here - old.at)
            self._snapshot = Snapshot(here, way)

    def _tell(self):
        with self._lock:
            snapshot = self._snapshot
        if snapshot is not None:
            self.get_logger().info(str(snapshot))


def main(args=None):
    rclpy.init(args=args)
    node = PoseSubscriber()
    executor = MultiThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
