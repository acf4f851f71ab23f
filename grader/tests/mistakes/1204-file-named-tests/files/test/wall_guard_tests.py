"""Tests of wall_guard: each one checks a promise, from outside, as another node would."""

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.clock import ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time
from turtlesim.msg import Pose

from my_robot_controller.wall_guard import WallGuard

STEP = 100_000_000  # 0.1 s in nanoseconds


class Bench:
    """The node under test, a second node that sends poses and listens, and a clock that only `run` advances."""

    def __init__(self):
        self.guard = WallGuard()
        self.guard.set_parameters([Parameter("use_sim_time", value=True)])
        self.listener = Node("listener")
        self.heard = []
        self.listener.create_subscription(Twist, "/turtle1/cmd_vel", self.heard.append, 10)
        self.poses = self.listener.create_publisher(Pose, "/turtle1/pose", 10)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.guard)
        self.executor.add_node(self.listener)
        self.now = 0
        self.run(1)

    def spin(self):
        # Each call runs at most one callback. Six calls are more than enough.
        for _ in range(6):
            self.executor.spin_once(timeout_sec=0)

    def run(self, steps):
        for _ in range(steps):
            self.now += STEP
            self.guard.get_clock().set_ros_time_override(Time(nanoseconds=self.now, clock_type=ClockType.ROS_TIME))
            self.spin()

    def pose(self, x, y):
        self.poses.publish(Pose(x=x, y=y))
        self.spin()


@pytest.fixture
def bench():
    rclpy.init()
    yield Bench()
    rclpy.shutdown()


def test_nothing_before_the_first_pose(bench):
    bench.run(5)
    assert bench.heard == []


def test_ten_commands_a_second(bench):
    bench.pose(5.0, 5.0)
    bench.run(10)
    assert len(bench.heard) == 10


def test_straight_on_in_the_middle(bench):
    bench.pose(5.0, 5.0)
    bench.run(2)
    command = bench.heard[-1]
    assert command.linear.x == pytest.approx(1.1)
    assert command.angular.z == pytest.approx(0.0)


@pytest.mark.parametrize(("x", "y"), [(0.5, 5.0), (10.5, 5.0), (5.0, 0.5), (5.0, 10.5)])
def test_turns_left_at_each_wall(bench, x, y):
    bench.pose(x, y)
    bench.run(2)
    command = bench.heard[-1]
    assert command.linear.x == pytest.approx(0.5)
    assert command.angular.z == pytest.approx(1.2)


def test_straight_on_again_after_the_wall(bench):
    bench.pose(10.5, 5.0)
    bench.run(2)
    bench.pose(9.0, 5.0)
    bench.run(2)
    assert bench.heard[-1].angular.z == pytest.approx(0.0)


def test_stops_when_no_pose_comes(bench):
    bench.pose(5.0, 5.0)
    bench.run(15)
    assert bench.heard[-1] == Twist()


