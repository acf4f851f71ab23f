import sys

import rclpy
from rclpy.node import Node
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from .circle_fit import fit_circle

POSE = """float32 x
float32 y
float32 theta
float32 linear_velocity
float32 angular_velocity
"""


class Report(Node):
    def __init__(self, bag):
        super().__init__("bag_report")
        store = get_typestore(Stores.ROS2_JAZZY)
        store.register(get_types_from_msg(POSE, "turtlesim/msg/Pose"))
        rows = []
        with Reader(bag) as reader:
            for connection, stamp, data in reader.messages():
                if connection.topic.endswith("/pose"):
                    pose = store.deserialize_cdr(data, connection.msgtype)
                    rows.append((stamp, pose.x, pose.y))
        if not rows:
            self.get_logger().error("no pose in this bag")
            sys.exit(2)
        stamps, xs, ys = zip(*rows)
        seconds = (stamps[-1] - stamps[0]) * 1e-9
        circle = fit_circle(xs, ys)
        print("some words before it")
        print("messages=%d rate=%.2f x=%.2f y=%.2f radius=%.2f" % (len(rows), (len(rows) - 1) / seconds, *circle))


def main():
    rclpy.init()
    Report(sys.argv[-1])
    rclpy.shutdown()
