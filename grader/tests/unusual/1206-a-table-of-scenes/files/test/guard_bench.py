"""Plays a scene to a guard, and returns the commands that the guard sent."""

import os

os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "OFF"

import rclpy
from geometry_msgs.msg import Twist
from rclpy.clock import ClockType
from rclpy.parameter import Parameter
from rclpy.time import Time
from turtlesim.msg import Pose

from my_robot_controller.wall_guard import WallGuard


def commands_after(*scene):
    """A scene is a series of places (x, y) and of numbers of ticks to wait. One tick is 0.1 s."""
    heard = []
    rclpy.init()
    try:
        guard, turtle = WallGuard(), rclpy.create_node("turtle")
        guard.set_parameters([Parameter("use_sim_time", value=True)])
        executor = rclpy.executors.SingleThreadedExecutor()
        executor.add_node(guard)
        executor.add_node(turtle)
        turtle.create_subscription(Twist, "/turtle1/cmd_vel", lambda msg: heard.append((msg.linear.x, msg.angular.z)), 10)
        poses = turtle.create_publisher(Pose, "/turtle1/pose", 10)
        ticks = 0
        for part in (1, *scene):
            if isinstance(part, tuple):
                poses.publish(Pose(x=part[0], y=part[1]))
                spin(executor)
                continue
            for _ in range(part):
                ticks += 1
                now = Time(nanoseconds=ticks * 100_000_000, clock_type=ClockType.ROS_TIME)
                guard.get_clock().set_ros_time_override(now)
                spin(executor)
    finally:
        rclpy.shutdown()
    return heard


def spin(executor):
    for _ in range(8):
        executor.spin_once(timeout_sec=0)
