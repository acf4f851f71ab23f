"""A comma in place of a dot is reported, and a comma between two values is not reported."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, fixed, reported

NO_NAME = "NameError: name '{}' is not defined"
NO_VALUES = "TypeError: cannot unpack non-iterable float object"
TOO_FEW = "ValueError: not enough values to unpack (expected 2, got 0)"
TOO_MANY = "ValueError: too many values to unpack (expected 2)"
IMPORTS = "import math\nimport rclpy\n"


@pytest.mark.parametrize(
    ("line", "error", "right"),
    [
        ("rclpy,spin(self)", NO_NAME.format("spin"), "rclpy.spin"),
        ("rclpy, spin(self)", NO_NAME.format("spin"), "rclpy.spin"),
        ("self.publisher,publish(step)", NO_NAME.format("publish"), "self.publisher.publish"),
        ("self.get_logger(),info('now')", NO_NAME.format("info"), "self.get_logger().info"),
        ("super(),__init__('driver')", NO_NAME.format("__init__"), "super().__init__"),
        ("self.timer = self,create_timer(1.0, self.send)", NO_NAME.format("create_timer"), "self.create_timer"),
        ("self,timer = 0", NO_VALUES, "self.timer"),
        ("step,linear.x = 2.0", NO_VALUES, "step.linear"),
        ("self,timers = []", TOO_FEW, "self.timers"),
        ("self,name = 'turtle1'", TOO_MANY, "self.name"),
        ("x = math,pi / 2", NO_NAME.format("pi"), "math.pi"),
        ("x = math.hypot(2 * step,x, step.x)", NO_NAME.format("x"), "step.x"),
    ],
)
def test_a_comma_in_place_of_a_dot_is_named(line: str, error: str, right: str) -> None:
    source = IMPORTS + DRIVER.format(line=line)
    found = reported(source, error)
    assert found.diagnosis == "comma-for-dot"
    assert found.cause.endswith(f"Write a dot: {right}.")
    assert right in (fixed(source, error) or "").splitlines()[source.splitlines().index(f"        {line}  # crashed")]


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("print(self, count)", NO_NAME.format("count")),
        ("math.hypot(step, x)", NO_NAME.format("x")),
        ("self.publish(step,count)", NO_NAME.format("count")),
        ("x, y = step, count", NO_NAME.format("count")),
        ("x, y = 2.0", NO_VALUES),
        ("x, y = []", TOO_FEW),
        ("spin(rclpy)", NO_NAME.format("spin")),
    ],
)
def test_a_comma_between_two_values_is_not_mistaken(line: str, error: str) -> None:
    assert reported(IMPORTS + DRIVER.format(line=line), error).diagnosis != "comma-for-dot"


@pytest.mark.parametrize("error", [TOO_FEW, TOO_MANY])
def test_names_and_values_of_different_numbers_are_explained(error: str) -> None:
    text = "The number of names differs from the number of values that are unpacked."
    assert reported(IMPORTS + DRIVER.format(line="x, y = read()"), error).cause == text
    assert reported(IMPORTS + DRIVER.format(line="x = read()"), "ValueError: not a number").cause != text
