"""The promises of wall_guard. The nodes spin in a thread of their own, as they would in a robot."""

import os
import threading

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

os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "OFF"

PATIENCE = 3.0  # s


class Driver(Node):
    """Plays the turtle, and counts the commands."""

    def __init__(self):
        super().__init__("driver")
        self.changed = threading.Condition()
        self.commands = []
        self.create_subscription(Twist, "/turtle1/cmd_vel", self.command_received, 50)
        self.turtle = self.create_publisher(Pose, "/turtle1/pose", 50)
        self.echoes = 0
        self.create_subscription(Pose, "/turtle1/pose", self.echo_received, 50)

    def command_received(self, command):
        with self.changed:
            self.commands.append(command)
            self.changed.notify_all()

    def echo_received(self, _):
        with self.changed:
            self.echoes += 1
            self.changed.notify_all()

    def wait_until(self, what):
        with self.changed:
            return self.changed.wait_for(what, timeout=PATIENCE)


class Lab:
    def __init__(self):
        self.guard = WallGuard()
        self.guard.set_parameters([Parameter("use_sim_time", value=True)])
        self.driver = Driver()
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.guard)
        self.executor.add_node(self.driver)
        self.thread = threading.Thread(target=self.executor.spin, daemon=True)
        self.thread.start()
        self.now = 0
        self.tick()

    def close(self):
        self.executor.shutdown()
        self.thread.join(PATIENCE)

    def let_all_callbacks_run(self):
        """Each task runs after what was ready before it. Six tasks in a row leave nothing undone."""
        for _ in range(6):
            done = threading.Event()
            self.executor.create_task(done.set)
            assert done.wait(PATIENCE)

    def tick(self, times=1):
        for _ in range(times):
            self.now += 100_000_000
            self.guard.get_clock().set_ros_time_override(Time(nanoseconds=self.now, clock_type=ClockType.ROS_TIME))
            self.let_all_callbacks_run()

    def turtle_at(self, x, y):
        before = self.driver.echoes
        self.driver.turtle.publish(Pose(x=x, y=y))
        assert self.driver.wait_until(lambda: self.driver.echoes > before)
        self.let_all_callbacks_run()

    def next_command(self):
        """Return the command after the next tick. A tick that brings no command is an error."""
        before = len(self.driver.commands)
        self.tick()
        assert self.driver.wait_until(lambda: len(self.driver.commands) > before), "no command"
        return self.driver.commands[-1]


@pytest.fixture
def lab():
    rclpy.init()
    lab = Lab()
    yield lab
    lab.close()
    rclpy.shutdown()


def test_silent_before_the_first_pose(lab):
    lab.tick(4)
    assert lab.driver.commands == []


def test_a_command_in_every_tick(lab):
    lab.turtle_at(5.0, 5.0)
    for _ in range(5):
        assert lab.next_command().linear.x == pytest.approx(1.1)


def test_left_at_each_wall_and_then_straight_on(lab):
    for x, y in ((0.5, 5.0), (10.5, 5.0), (5.0, 0.5), (5.0, 10.5)):
        lab.turtle_at(x, y)
        command = lab.next_command()
        assert command.linear.x == pytest.approx(0.5)
        assert command.angular.z == pytest.approx(1.2)
        lab.turtle_at(5.0, 5.0)
        command = lab.next_command()
        assert command.linear.x == pytest.approx(1.1)
        assert command.angular.z == pytest.approx(0.0)


def test_it_stops_without_poses(lab):
    lab.turtle_at(5.0, 5.0)
    lab.tick(10)
    assert lab.driver.commands[-1].linear.x == pytest.approx(1.1)
    lab.tick(5)
    assert lab.driver.commands[-1] == Twist()
