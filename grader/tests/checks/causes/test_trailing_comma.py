"""A comma after a value makes a tuple, which Python or rclpy refuses later."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import LOOK, fixed, line_with, reported

FIELD = "AssertionError: The 'x' field must be of type 'float'"
SECONDS = "TypeError: float() argument must be a string or a real number, not 'tuple'"
ADDED = 'TypeError: can only concatenate tuple (not "int") to tuple'
NAME = "TypeError: rclpy_resolve_name(): incompatible function arguments."
DRIVER = """\
from rclpy.node import Node

TOPIC = "/turtle1/cmd_vel"

class Driver(Node):
    turns = 0

    def __init__(self):
        super().__init__("driver")
        self.period = 0.5
        self.publisher = self.create_publisher(
            Twist, TOPIC, 10
        )
        step = 1

    def send(self):
        step = 2
        {line}  # crashed
"""


def driver(line: str, value: str, given: str) -> str:
    source = DRIVER.format(line=line)
    assert source.count(f"{value}\n") == 1
    return source.replace(f"{value}\n", f"{given}  # look\n")


@pytest.mark.parametrize(
    ("line", "value", "error", "name"),
    [
        ("self.create_timer(self.period, self.send)", "self.period = 0.5", SECONDS, "self.period"),
        ("msg.linear.x = self.period", "self.period = 0.5", FIELD, "self.period"),
        ("self.create_subscription(Twist, TOPIC, self.send, 10)", '"/turtle1/cmd_vel"', NAME, "TOPIC"),
        ("self.turns += 1", "    turns = 0", ADDED, "self.turns"),
        ("step += 1", "step = 2", ADDED, "step"),
        (
            "self.publisher.publish(msg)",
            "        )",
            "AttributeError: 'tuple' object has no attribute 'publish'",
            "self.publisher",
        ),
    ],
)
def test_the_comma_after_the_value_is_named_where_it_is(line: str, value: str, error: str, name: str) -> None:
    source = driver(line, value, f"{value},")
    found = reported(source, error)
    at = line_with(LOOK, source)
    assert (found.diagnosis, found.line) == ("trailing-comma", at)
    assert found.cause == f"The comma after the value on line {at} makes {name} a tuple with one value."
    assert fixed(source, error) == source.replace(",  # look", "  # look")


@pytest.mark.parametrize(
    ("line", "value", "given", "error"),
    [
        ("self.create_timer(self.period, self.send)", "self.period = 0.5", "self.period = (0.5,)", SECONDS),
        ("self.create_timer(self.period, self.send)", "self.period = 0.5", "self.period = 0.5, 1.0", SECONDS),
        ("self.create_timer(self.period, self.send)", "self.period = 0.5", "self.period = 0.5,", "TypeError: other"),
        ("self.create_timer(self.pause, self.send)", "self.period = 0.5", "self.period = 0.5,", SECONDS),
        ("self.create_timer(step, self.send)", "step = 1", "step = 1,", SECONDS),
    ],
)
def test_a_tuple_that_is_meant_or_is_elsewhere_is_not_blamed(line: str, value: str, given: str, error: str) -> None:
    assert "comma after the value" not in reported(driver(line, value, given), error).cause


def test_the_line_of_the_crash_may_have_the_comma_itself() -> None:
    source = DRIVER.format(line="msg.linear.x = 2.0,")
    found = reported(source, FIELD)
    assert found.cause.startswith("The comma after the value on line 18 makes msg.linear.x a tuple")
    assert "decimal" not in found.cause
    assert fixed(source, FIELD) == source.replace("2.0,", "2.0")
    assert "Write a dot, not a comma" in reported(DRIVER.format(line="msg.linear.x = 2,0"), FIELD).cause
