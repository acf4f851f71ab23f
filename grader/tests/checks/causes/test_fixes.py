"""The smallest change that fixes the cause of a crash."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, fixed

CLASS = "class Driver(Node):\n    def __init__(self):\n        super().__init__('driver')\n"


@pytest.mark.parametrize(
    ("source", "error", "line"),
    [
        (DRIVER.format(line="print(count)"), "NameError: name 'count' is not defined", "print(self.count)"),
        (DRIVER.format(line="print(conut.x + step)"), "NameError: name 'conut' is not defined", None),
        ("import math\nx = pi  # crashed\n", "NameError: name 'pi' is not defined", "x = math.pi"),
        ("import rclpy\nx = Twist()  # crashed\n", "NameError: name 'Twist' is not defined", "from geometry_msgs.msg"),
        ("x = true  # crashed\n", "NameError: name 'true' is not defined", "x = True"),
        ("rclpy.spni(node)  # crashed\n", "AttributeError: module 'rclpy' has no attribute 'spni'", "rclpy.spin(node)"),
        ("msg.liner.x = 1.0  # crashed\n", "AttributeError: 'Twist' object has no attribute 'liner'", "msg.linear.x"),
        (
            f"{CLASS}        speed = 1.0\n\n    def send(self):\n        print(self.speed)  # crashed\n",
            "AttributeError: 'Driver' object has no attribute 'speed'",
            "self.speed = 1.0",
        ),
        (
            f"{CLASS}        self.create_timer(0.5, self.send())  # crashed\n\n    def send(self):\n        pass\n",
            "TypeError: x",
            "create_timer(0.5, self.send)",
        ),
        (
            "from geometry_msgs import Twist  # crashed\n",
            "ImportError: cannot import name 'Twist' from 'geometry_msgs' (/x)",
            "from geometry_msgs.msg import Twist",
        ),
        ("import geometry_msg  # crashed\n", "ModuleNotFoundError: No module named 'geometry_msg'", "geometry_msgs"),
        (
            "from geometry_msgs.msgs import Twist  # crashed\n",
            "ModuleNotFoundError: No module named 'geometry_msgs.msgs'",
            "from geometry_msgs.msg import Twist",
        ),
        (
            "msg.linear.x = 2  # crashed\n",
            "AssertionError: The 'x' field must be of type 'float'",
            "msg.linear.x = 2.0",
        ),
        ("x = 1 / 0  # crashed\n", "ZeroDivisionError: division by zero", None),
    ],
)
def test_a_cause_that_is_known_well_has_a_fix(source: str, error: str, line: str | None) -> None:
    after = fixed(source, error)
    assert (after is None) == (line is None)
    assert line is None or line in (after or "")
