from unittest import mock

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.clock import ClockType
from rclpy.parameter import Parameter
from rclpy.time import Time
from turtlesim.msg import Pose

from my_robot_controller.wall_guard import WallGuard


@pytest.fixture(scope="module", autouse=True)
def ros():
    rclpy.init()
    yield
    rclpy.shutdown()


@pytest.fixture
def guard():
    node = WallGuard()
    node.set_parameters([Parameter("use_sim_time", value=True)])
    at(node, 1.0)
    assert (node.publisher.topic_name, node.publisher.msg_type) == ("/turtle1/cmd_vel", Twist)
    node.publisher = mock.Mock()
    yield node
    node.destroy_node()


def at(node, seconds):
    node.get_clock().set_ros_time_override(Time(seconds=seconds, clock_type=ClockType.ROS_TIME))


def answer(node, x, y, after=0.1):
    node.on_pose(Pose(x=x, y=y))
    at(node, 1.0 + after)
    node.send()
    (command,) = node.publisher.publish.call_args.args
    return command.linear.x, command.angular.z


def test_period(guard):
    assert guard.timer.timer_period_ns == 100_000_000


def test_silent(guard):
    guard.send()
    guard.publisher.publish.assert_not_called()


@pytest.mark.parametrize("place", [(0.2, 5.0), (10.9, 5.0), (5.0, 0.2), (5.0, 10.9)])
def test_walls(guard, place):
    assert answer(guard, *place) == (0.5, 1.2)
    assert answer(guard, 5.0, 5.0) == (1.1, 0.0)


def test_stop(guard):
    assert answer(guard, 5.0, 5.0, after=1.5) == (0.0, 0.0)
