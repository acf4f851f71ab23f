from cmath import polar

import rclpy
from rclpy.executors import ExternalShutdownException
from turtlesim.msg import Pose


def odometer():
    total, last = 0.0, None
    while True:
        pose = yield total
        here = pose.x + 1j * pose.y
        if last is not None:
            total += polar(here - last)[0]
        last = here


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("pose_subscriber")
    way = odometer()
    next(way)
    heard = 0

    def on_pose(pose):
        nonlocal heard
        distance = way.send(pose)
        heard += 1
        if heard % 62 == 0:
            node.get_logger().info("x={0.x:.2f} y={0.y:.2f} distance={1:.2f}".format(pose, distance))

    node.create_subscription(Pose, "/turtle1/pose", on_pose, 10)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
