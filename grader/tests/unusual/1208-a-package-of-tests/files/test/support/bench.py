"""A bench for the guard, which test modules of this package share."""

import os
from dataclasses import dataclass, field

os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")

import rclpy
from geometry_msgs.msg import Twist
from rclpy.clock import ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time
from turtlesim.msg import Pose

from my_robot_controller.wall_guard import WallGuard


@dataclass
class Command:
    speed: float
    turn: float


@dataclass
class Bench:
    guard: WallGuard = field(default_factory=WallGuard)
    other: Node = field(default_factory=lambda: Node("other"))
    executor: SingleThreadedExecutor = field(default_factory=SingleThreadedExecutor)
    commands: list = field(default_factory=list)
    time_ms: int = 0

    def __post_init__(self):
        self.guard.set_parameters([Parameter("use_sim_time", value=True)])
        self.other.create_subscription(Twist, "/turtle1/cmd_vel", self._keep, 10)
        self.poses = self.other.create_publisher(Pose, "/turtle1/pose", 10)
        for node in (self.guard, self.other):
            self.executor.add_node(node)
        self.wait(0.1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        rclpy.shutdown()

    def _keep(self, command):
        self.commands.append(Command(command.linear.x, command.angular.z))

    def wait(self, seconds):
        for _ in range(round(seconds * 20)):
            self.time_ms += 50
            now = Time(nanoseconds=self.time_ms * 1_000_000, clock_type=ClockType.ROS_TIME)
            self.guard.get_clock().set_ros_time_override(now)
            self._spin()
        return self

    def turtle(self, x, y):
        self.poses.publish(Pose(x=x, y=y))
        self._spin()
        return self

    def _spin(self):
        for _ in range(8):
            self.executor.spin_once(timeout_sec=0)


def new_bench():
    rclpy.init()
    return Bench()
