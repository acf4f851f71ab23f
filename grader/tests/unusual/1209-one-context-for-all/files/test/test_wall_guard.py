import os
import unittest
from unittest import mock

import rclpy
from geometry_msgs.msg import Twist
from rclpy.clock import ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.time import Time
from turtlesim.msg import Pose

from my_robot_controller.wall_guard import WallGuard


class GuardCase(unittest.TestCase):
    """A fresh guard for each test, in one ROS 2 context for all of them."""

    @classmethod
    def setUpClass(cls):
        rclpy.init()
        cls.addClassCleanup(rclpy.shutdown)

    def setUp(self):
        self.guard = WallGuard()
        self.addCleanup(self.guard.destroy_node)
        self.world = rclpy.create_node("world")
        self.addCleanup(self.world.destroy_node)
        self.guard.set_parameters([Parameter("use_sim_time", value=True)])
        self.heard = mock.Mock(return_value=None)
        self.world.create_subscription(Twist, "/turtle1/cmd_vel", lambda message: self.heard(message), 10)
        self.poses = self.world.create_publisher(Pose, "/turtle1/pose", 10)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.guard)
        self.executor.add_node(self.world)
        self.tenths = 0
        self.advance()

    def advance(self, tenths=1):
        for _ in range(tenths):
            self.tenths += 1
            now = Time(nanoseconds=self.tenths * 100_000_000, clock_type=ClockType.ROS_TIME)
            self.guard.get_clock().set_ros_time_override(now)
            self.spin()

    def spin(self):
        for _ in range(8):
            self.executor.spin_once(timeout_sec=0)

    def place(self, x, y):
        self.poses.publish(Pose(x=x, y=y))
        self.spin()

    def assert_last(self, speed, turn):
        (command,), _ = self.heard.call_args
        self.assertAlmostEqual(command.linear.x, speed)
        self.assertAlmostEqual(command.angular.z, turn)


class WhenItSpeaks(GuardCase):
    def test_never_before_a_pose(self):
        self.advance(5)
        self.heard.assert_not_called()

    def test_every_tenth_of_a_second(self):
        self.place(5.0, 5.0)
        self.advance(10)
        self.assertEqual(self.heard.call_count, 10)

    def test_with_zeros_when_the_pose_is_old(self):
        self.place(5.0, 5.0)
        self.advance(11)
        self.assert_last(1.1, 0.0)
        self.advance(4)
        self.assert_last(0.0, 0.0)


class HowItDrives(GuardCase):
    def test_straight_on(self):
        self.place(5.0, 5.0)
        self.advance(2)
        self.assert_last(1.1, 0.0)

    def test_to_the_left_at_each_wall(self):
        for x, y in [(0.5, 5.0), (10.5, 5.0), (5.0, 0.5), (5.0, 10.5)]:
            self.place(x, y)
            self.advance(2)
            self.assert_last(0.5, 1.2)
            self.place(5.0, 5.0)
            self.advance(2)
            self.assert_last(1.1, 0.0)


if __name__ == "__main__":
    unittest.main()
