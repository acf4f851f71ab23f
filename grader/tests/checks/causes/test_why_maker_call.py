"""Wrong arguments of create_timer and similar methods, and such methods that are called on something else."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, reported


@pytest.mark.parametrize(
    ("line", "error", "diagnosis", "cause"),
    [
        (
            "self.create_timer([0.5], self.send)",
            "TypeError: float() argument must be a string or a real number, not 'list'",
            "crash",
            "The first argument of create_timer is the period, a number of seconds.",
        ),
        (
            'self.create_timer(0.5, "send")',
            "TypeError: 'str' object is not callable",
            "not-callable",
            "The callback of a timer is the method itself. Write self.send without quotation marks.",
        ),
        (
            'self.create_timer(0.5, "send()")',
            "TypeError: 'str' object is not callable",
            "not-callable",
            "The callback of a timer is the method itself. Write self, a dot and its name, without quotation marks.",
        ),
        (
            "rclpy.spin(self)",
            "TypeError: Driver.__init__.<locals>.<lambda>() missing 1 required positional argument: 'msg'",
            "callback-parameters",
            (
                "A lambda is called without a value for 'msg'. A timer passes no argument to its callback; a "
                "subscription passes the message."
            ),
        ),
        (
            "rclpy.spin(self)",
            "TypeError: Driver.__init__.<locals>.<lambda>() takes 0 positional arguments but 1 was given",
            "callback-parameters",
            "A lambda is called with an argument, but it has no parameter.",
        ),
        (
            "Node.create_publisher(Twist, 'a', 10)",
            "TypeError: Node.create_publisher() missing 1 required positional argument: 'qos_profile'",
            "class-for-object",
            (
                "This line calls create_publisher on the class Node. Inside a method of the node, write "
                "self.create_publisher."
            ),
        ),
        (
            "rclpy.create_timer(0.5, self.send)",
            "AttributeError: module 'rclpy' has no attribute 'create_timer'",
            "attribute-missing",
            (
                "create_timer is a method of the node, not a function of rclpy. In a method of the node, write "
                "self.create_timer."
            ),
        ),
        (
            "self.create_timer(0,5, self.send)",
            "AttributeError: 'function' object has no attribute 'add_entity'",
            "comma-for-dot",
            "A comma separates two numbers. Write a dot in a decimal number: 0.5.",
        ),
        (
            "self.publisher = self.publisher(Twist, 'a', 10)",
            "AttributeError: 'Driver' object has no attribute 'publisher'",
            "attribute-misspelt",
            "A node has no method publisher. A similar name exists: create_publisher.",
        ),
        (
            "self.total = self.total + 1",
            "AttributeError: 'Driver' object has no attribute 'total'",
            "attribute-too-early",
            "This line needs a value of self.total. Assign a first value on an earlier line.",
        ),
        (
            "self.create_publisher(float, 'a', 10)",
            "AttributeError: type object 'type' has no attribute '_TYPE_SUPPORT'",
            "wrong-type",
            "The type must be a class of ROS 2, such as Twist from geometry_msgs.msg, and not a class of Python.",
        ),
        (
            "self.create_publisher(Twist, 'a', -1)",
            "ValueError: history depth must be greater than or equal to zero",
            "queue-size",
            "The queue size is a whole number, and cannot be negative.",
        ),
        (
            "self.create_subscription(Pose, 'a', self.send(msg), 10)",
            "NameError: name 'msg' is not defined",
            "callback-called",
            "create_subscription needs the method itself. With () after its name, the method is called immediately.",
        ),
        (
            "self.create_publisher(rclpy.node.Node, 'a', 10)",
            "NameError: name 'rclpy' is not defined",
            "missing-import",
            "The file does not import the module rclpy.",
        ),
    ],
)
def test_a_wrong_argument_is_explained(line: str, error: str, diagnosis: str, cause: str) -> None:
    found = reported(DRIVER.format(line=line), error)
    assert (found.diagnosis, found.cause) == (diagnosis, cause)


def test_a_module_from_which_only_names_are_imported_is_not_a_name() -> None:
    source = f"from turtlesim.msg import Pose\n{DRIVER.format(line='print(turtlesim.msg.Pose)')}"
    text = "Line 1 gives the file Pose, but not the name turtlesim. Leave out the module here."
    assert reported(source, "NameError: name 'turtlesim' is not defined").cause == text
