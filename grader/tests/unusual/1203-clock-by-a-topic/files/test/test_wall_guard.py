"""The promises of wall_guard. A publisher on /clock is the time, for the guard as for every other node."""

import os
from contextlib import contextmanager

import pytest
import rclpy
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from turtlesim.msg import Pose

from my_robot_controller.wall_guard import WallGuard

os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "OFF"

MIDDLE = Pose(x=5.5, y=5.5)
TICK_MS = 50


class World:
    """The simulator's side: its clock, its turtle, and a list of the commands that arrived."""

    def __init__(self, guard):
        self.node = rclpy.create_node("world")
        self.clock = self.node.create_publisher(Clock, "/clock", 10)
        self.turtle = self.node.create_publisher(Pose, "/turtle1/pose", 10)
        self.commands = []
        self.node.create_subscription(Twist, "/turtle1/cmd_vel", self.commands.append, 10)
        self.executor = SingleThreadedExecutor()
        for node in (self.node, guard):
            self.executor.add_node(node)
        self.ms = 0
        self.wait(0.1)

    def settle(self):
        for _ in range(10):
            self.executor.spin_once(timeout_sec=0)

    def wait(self, seconds, pose=None):
        for _ in range(round(seconds * 1000 / TICK_MS)):
            if pose is not None:
                self.turtle.publish(pose)
                self.settle()
            self.ms += TICK_MS
            whole, rest = divmod(self.ms, 1000)
            self.clock.publish(Clock(clock=Time(sec=whole, nanosec=rest * 1_000_000)))
            self.settle()


@contextmanager
def world():
    rclpy.init()
    try:
        guard = WallGuard()
        guard.set_parameters([Parameter("use_sim_time", value=True)])
        yield World(guard)
    finally:
        rclpy.shutdown()


@pytest.mark.parametrize("seconds", [0.3, 2.0])
def test_it_keeps_silent_without_a_pose(seconds):
    with world() as here:
        here.wait(seconds)
        assert not here.commands


def test_one_command_in_a_tenth_of_a_second():
    with world() as here:
        here.wait(3.0, MIDDLE)
        assert len(here.commands) == pytest.approx(30, abs=1)


def test_straight_on():
    with world() as here:
        here.wait(0.3, MIDDLE)
        assert here.commands[-1].linear.x == pytest.approx(1.1)
        assert here.commands[-1].angular.z == 0.0


@pytest.mark.parametrize("pose", [Pose(x=0.9, y=6.0), Pose(x=10.1, y=6.0), Pose(x=6.0, y=0.9), Pose(x=6.0, y=10.1)])
def test_left_at_a_wall_and_straight_on_after_it(pose):
    with world() as here:
        here.wait(0.3, pose)
        near = here.commands[-1]
        here.wait(0.3, MIDDLE)
        far = here.commands[-1]
    assert (near.linear.x, near.angular.z) == pytest.approx((0.5, 1.2))
    assert (far.linear.x, far.angular.z) == pytest.approx((1.1, 0.0))


def test_it_stops_when_the_poses_stop():
    with world() as here:
        here.wait(0.3, MIDDLE)
        here.wait(1.0)
        assert here.commands[-1].linear.x == pytest.approx(1.1)
        here.wait(0.5)
        assert here.commands[-1] == Twist()
