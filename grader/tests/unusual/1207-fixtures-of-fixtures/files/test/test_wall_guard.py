"""Each fixture adds one thing: ROS 2, the guard, its ears, its clock."""

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.clock import ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.time import Time
from turtlesim.msg import Pose

from my_robot_controller import wall_guard

MIDDLE = (5.5, 5.5)


@pytest.fixture(autouse=True)
def ros(monkeypatch):
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    monkeypatch.setenv("ROS_DOMAIN_ID", "42")
    rclpy.init()
    yield
    rclpy.try_shutdown()


@pytest.fixture
def guard():
    guard = wall_guard.WallGuard()
    guard.set_parameters([Parameter("use_sim_time", value=True)])
    yield guard
    guard.destroy_node()


@pytest.fixture
def ear():
    ear = rclpy.create_node("ear")
    yield ear
    ear.destroy_node()


@pytest.fixture
def commands(ear):
    commands = []
    ear.create_subscription(Twist, "/turtle1/cmd_vel", commands.append, 10)
    return commands


@pytest.fixture
def settle(guard, ear):
    executor = SingleThreadedExecutor()
    executor.add_node(guard)
    executor.add_node(ear)

    def settle():
        for _ in range(8):
            executor.spin_once(timeout_sec=0)

    return settle


@pytest.fixture
def after(guard, settle):
    """A function that lets some tenths of a second pass."""
    passed = 0

    def after(tenths):
        nonlocal passed
        for _ in range(tenths):
            passed += 1
            now = Time(nanoseconds=passed * 10**8, clock_type=ClockType.ROS_TIME)
            guard.get_clock().set_ros_time_override(now)
            settle()

    after(1)
    return after


@pytest.fixture
def turtle(request, ear, commands, after, settle):
    """The turtle stands at the place that the test names, MIDDLE if it names none."""
    x, y = getattr(request, "param", MIDDLE)
    poses = ear.create_publisher(Pose, "/turtle1/pose", 10)

    def moved(x, y):
        poses.publish(Pose(x=x, y=y))
        settle()

    moved(x, y)
    return moved


def test_no_turtle_no_command(commands, after):
    after(7)
    assert commands == []


@pytest.mark.parametrize("tenths", [1, 5, 10])
def test_one_command_for_each_tenth(turtle, commands, after, tenths):
    after(tenths)
    assert len(commands) == tenths


@pytest.mark.usefixtures("turtle")
def test_straight_on(commands, after):
    after(1)
    assert (commands[-1].linear.x, commands[-1].angular.z) == pytest.approx((1.1, 0.0))


@pytest.mark.parametrize("turtle", [(0.5, 5.0), (10.5, 5.0), (5.0, 0.5), (5.0, 10.5)], indirect=True)
def test_left_at_the_wall_and_straight_on_after_it(turtle, commands, after):
    after(1)
    assert (commands[-1].linear.x, commands[-1].angular.z) == pytest.approx((0.5, 1.2))
    turtle(*MIDDLE)
    after(1)
    assert (commands[-1].linear.x, commands[-1].angular.z) == pytest.approx((1.1, 0.0))


@pytest.mark.usefixtures("turtle")
def test_old_poses_stop_it(commands, after):
    after(11)
    assert commands[-1] != Twist()
    after(3)
    assert commands[-1] == Twist()
