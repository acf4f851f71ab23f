import os
from contextlib import ExitStack

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.clock import ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.time import Time
from turtlesim.msg import Pose

from my_robot_controller.wall_guard import WallGuard

os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "OFF"


class World:
    def __init__(self):
        self.guard, self.node = WallGuard(), rclpy.create_node("scene")
        self.guard.set_parameters([Parameter("use_sim_time", value=True)])
        self.heard = []
        self.node.create_subscription(Twist, "/turtle1/cmd_vel", self.heard.append, 20)
        self.pose = self.node.create_publisher(Pose, "/turtle1/pose", 20)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.guard)
        self.executor.add_node(self.node)
        self.tenths = 0
        self.play(1)

    def put(self, x, y):
        self.pose.publish(Pose(x=x, y=y))
        self.settle()

    def play(self, tenths):
        for _ in range(tenths):
            self.tenths += 1
            time = Time(seconds=self.tenths // 10, nanoseconds=self.tenths % 10 * 10**8, clock_type=ClockType.ROS_TIME)
            self.guard.get_clock().set_ros_time_override(time)
            self.settle()

    def settle(self):
        for _ in range(8):
            self.executor.spin_once(timeout_sec=0)


@pytest.fixture
def world():
    with ExitStack() as stack:
        rclpy.init()
        stack.callback(rclpy.shutdown)
        yield World()


def test_a_scene(world, scene):
    world.put(float(scene["x"]), float(scene["y"]))
    world.play(int(scene["tenths"]))
    assert len(world.heard) == int(scene["commands"])
    assert world.heard[-1].linear.x == pytest.approx(float(scene["speed"]))
    assert world.heard[-1].angular.z == pytest.approx(float(scene["turn"]))


def test_silence_first(world):
    world.play(10)
    assert len(world.heard) == 0


def test_away_from_the_wall_again(world):
    world.put(0.5, 5.0)
    world.play(2)
    world.put(5.0, 5.0)
    world.play(2)
    assert world.heard[-1].angular.z == pytest.approx(0.0)
