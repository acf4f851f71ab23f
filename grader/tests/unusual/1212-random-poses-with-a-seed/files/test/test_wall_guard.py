"""Random positions with a fixed seed, compared with an independent model of the promises."""
import os
from collections import namedtuple
from contextlib import ExitStack, contextmanager

os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "OFF"

import numpy as np
import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time
from turtlesim.msg import Pose

import my_robot_controller.wall_guard as under_test

Command = namedtuple("Command", "vx vy vz wx wy wz")
STOP = Command(0, 0, 0, 0, 0, 0)


class Probe(Node):
    def __init__(self):
        super().__init__("probe")
        self.heard = []
        self.create_subscription(Twist, "turtle1/cmd_vel", self.hear, 10)
        self.say = self.create_publisher(Pose, "turtle1/pose", 10)

    def hear(self, m):
        self.heard.append(Command(m.linear.x, m.linear.y, m.linear.z, m.angular.x, m.angular.y, m.angular.z))


def model(x, y, age):
    """What the promises say."""
    if age > 1.2:
        return STOP
    near = x < 1 or x > 10 or y < 1 or y > 10
    return Command(0.5, 0, 0, 0, 0, 1.2) if near else Command(1.1, 0, 0, 0, 0, 0)


@contextmanager
def laboratory():
    with ExitStack() as stack:
        rclpy.init()
        stack.callback(rclpy.try_shutdown)
        guard, probe = under_test.WallGuard(), Probe()
        guard.set_parameters([Parameter("use_sim_time", value=True)])
        executor = SingleThreadedExecutor()
        executor.add_node(guard)
        executor.add_node(probe)
        clock = guard.get_clock()
        now = [1_000_000_000]

        def pump():
            for _ in range(6):
                executor.spin_once(timeout_sec=0.0)

        def step(n=1):
            for _ in range(n):
                now[0] += 100_000_000
                clock.set_ros_time_override(Time(nanoseconds=now[0], clock_type=clock.clock_type))
                pump()

        def pose(x, y):
            probe.say.publish(Pose(x=float(x), y=float(y), theta=1.0, linear_velocity=0.5))
            pump()

        step()
        yield pose, step, probe.heard
        executor.shutdown()


@pytest.fixture
def lab():
    with laboratory() as parts:
        yield parts


def test_nothing_before_pose(lab):
    pose, step, heard = lab
    step(20)
    assert heard == []
    pose(5, 5)
    step()
    assert len(heard) == 1


@pytest.mark.parametrize("seed", range(3))
def test_as_the_model(lab, seed):
    pose, step, heard = lab
    rng = np.random.default_rng(seed)
    for x, y in rng.uniform(0.0, 11.0, (60, 2)).round(2):
        pose(x, y)
        step()
        assert heard[-1] == pytest.approx(model(x, y, 0.1)), (x, y)
    assert len(heard) == 60


@pytest.mark.parametrize("place", [(5.5, 5.5), (0.3, 5), (10.7, 5), (5, 0.3), (5, 10.7)], ids=str)
def test_ages(lab, place):
    pose, step, heard = lab
    pose(*place)
    for tick in range(1, 25):
        step()
        assert len(heard) == tick
        if tick != 12:  # exactly the limit
            assert heard[-1] == pytest.approx(model(*place, tick / 10))
    pose(*place)
    step()
    assert heard[-1] == pytest.approx(model(*place, 0.1))
