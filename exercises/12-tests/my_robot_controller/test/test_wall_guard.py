"""Tests of wall_guard: each one checks a promise, from outside, as another node would."""

import os

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

os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "OFF"  # no other program takes part in the tests

# TODO 3: write a class Bench with the guard, a listener beside it, and a clock that you advance.

# TODO 4: write a fixture that gives each test a fresh bench.

# TODO 5: write tests for all promises in wall_guard.py.
