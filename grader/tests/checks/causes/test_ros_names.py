"""The names that the grader knows from ROS 1 and ROS 2."""

from __future__ import annotations

import pytest

from grader.checks.causes.ros_names import OF_ROS_1
from grader.tests.checks.crashes import DRIVER, reported


def cause(name: str) -> str:
    """Return the cause for a node that calls a function of the module rclpy that does not exist."""
    error = f"AttributeError: module 'rclpy' has no attribute '{name}'"
    return reported("import rclpy\n" + DRIVER.format(line=f"rclpy.{name}()"), error).cause


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("init_node", "The node gets its name in super().__init__."),
        ("is_shutdown", "In ROS 2, rclpy.ok() returns the opposite."),
        ("Publisher", "In ROS 2, the method create_publisher of the node creates a publisher."),
        ("Subscriber", "In ROS 2, the method create_subscription of the node creates a subscription."),
        ("Rate", "In ROS 2, a node does periodic work in the callback of a timer."),
        ("Timer", "In ROS 2, the method create_timer of the node creates a timer."),
        ("sleep", "In ROS 2, a node does periodic work in the callback of a timer."),
        ("get_time", "In ROS 2, the node's clock gives the time: get_clock().now()."),
        ("get_param", "In ROS 2, a node has declare_parameter and get_parameter."),
        ("set_param", "In ROS 2, a node has declare_parameter and set_parameters."),
        ("ServiceProxy", "In ROS 2, the method create_client of the node creates a client."),
        ("Service", "In ROS 2, the method create_service of the node offers a service."),
        ("wait_for_service", "In ROS 2, a client has the methods wait_for_service and service_is_ready."),
        ("loginfo", "In ROS 2, the logger has the method info."),
        ("logwarn", "In ROS 2, the logger has the method warning."),
        ("logerr", "In ROS 2, the logger has the method error."),
    ],
)
def test_what_replaces_a_name_of_rospy_is_told_for_that_name_only(name: str, words: str) -> None:
    assert cause(name) == f"{name} belongs to rospy, the Python library of ROS 1. {words}"
    others = [other for other, text in OF_ROS_1.items() if text != words]
    assert not any(words in cause(other) for other in (*others, "spinn"))


@pytest.mark.parametrize(
    ("name", "module"),
    [("wait_for_message", "wait_for_message"), ("Duration", "duration"), ("Time", "time"), ("Node", "node")],
)
def test_a_name_that_rclpy_has_in_a_module_is_not_one_of_ros_1(name: str, module: str) -> None:
    assert cause(name) == f"{name} is in the module rclpy.{module}."


@pytest.mark.parametrize(("near", "name"), [("spinn", "spin"), ("intt", "init")])
def test_a_name_that_rospy_does_not_have_is_not_one_of_ros_1(near: str, name: str) -> None:
    assert "belongs to rospy" not in cause(near)
    assert f"A similar name exists: {name}." in cause(near)


@pytest.mark.parametrize(("name", "told"), [("get_param", True), ("ServiceProxy", True), ("get_parm", False)])
def test_a_function_of_rospy_is_not_a_method_of_a_node(name: str, *, told: bool) -> None:
    error = f"AttributeError: 'Driver' object has no attribute '{name}'"
    found = reported("import rclpy\n" + DRIVER.format(line=f"self.{name}()"), error)
    assert (f"{name} belongs to rospy, the Python library of ROS 1." in found.cause) == told
