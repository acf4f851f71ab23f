"""The reason why a computation with None fails."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported

NODE = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.x = {first}
        self.step = None
        self.old = None

    def take(self, pose):
        self.x = pose.x
        self.old = pose

    def send(self):
        {line}  # crashed
"""
FIRST = "self.x is None until it gets a value. Check for None before you compute with it."
BOTH = "self.x and self.y are None until they get a value. Check for None before you compute with them."
MINUS_NONE = "unsupported operand type(s) for -: 'float' and 'NoneType'"
ONE_SIDE = "An operand is None, which is not a number."


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("dx = place.x - self.x", MINUS_NONE),
        ("dx = self.x + 1.0", "unsupported operand type(s) for +: 'NoneType' and 'float'"),
        ("self.x += 1.0", "unsupported operand type(s) for +=: 'NoneType' and 'float'"),
        ("dx = self.old.x - self.x", MINUS_NONE),
        ("dx = -self.x", "bad operand type for unary -: 'NoneType'"),
        ("near = self.x < 3.0", "'<' not supported between instances of 'NoneType' and 'float'"),
    ],
)
def test_an_attribute_that_is_none_at_first_is_named(line: str, error: str) -> None:
    found = reported(NODE.format(first="None", line=line), f"TypeError: {error}")
    assert (found.diagnosis, found.cause) == ("none-before-message", FIRST)


def test_every_attribute_of_the_line_that_is_none_at_first_is_named() -> None:
    node = (
        NODE.replace("self.old = pose", "self.y = pose.y")
        .replace("self.old", "self.y")
        .format(first="None", line="away = math.hypot(place.x - self.x, place.y - self.y)")
    )
    found = reported(node, f"TypeError: {MINUS_NONE}")
    assert (found.diagnosis, found.cause) == ("none-before-message", BOTH)
    known = reported(node.replace("self.y = None", "self.y = 0.0"), f"TypeError: {MINUS_NONE}")
    assert "are None until they get a value" not in known.cause
    assert known.cause == FIRST


@pytest.mark.parametrize(("first", "line"), [("0.0", "dx = self.x + 1.0"), ("None", "dx = self.step + 1.0")])
def test_a_none_from_elsewhere_blames_no_attribute(first: str, line: str) -> None:
    error = "TypeError: unsupported operand type(s) for +: 'NoneType' and 'float'"
    found = reported(NODE.format(first=first, line=line), error)
    assert (found.diagnosis, found.cause) == ("crash", ONE_SIDE)


def test_a_string_plus_a_number_has_nothing_to_do_with_none() -> None:
    error = "TypeError: unsupported operand type(s) for +: 'int' and 'str'"
    assert reported(NODE.format(first="None", line="dx = 1 + self.x"), error).diagnosis == "string-and-number"


MODULE_VARIABLE = """\
publisher = None

def send():
    publisher.publish(Twist())  # crashed

def main():
    {line}
    publisher = rclpy.create_node("driver").create_publisher(Twist, "/turtle1/cmd_vel", 10)
"""


@pytest.mark.parametrize(("line", "told"), [("rclpy.init()", True), ("global publisher", False)])
def test_a_variable_of_the_module_is_set_only_with_global(line: str, *, told: bool) -> None:
    found = reported(MODULE_VARIABLE.format(line=line), "AttributeError: 'NoneType' object has no attribute 'publish'")
    words = "main gives a value only to its own local variable publisher. To set the variable of the module, main needs"
    assert (words in found.cause, found.diagnosis) == (told, "local-name" if told else "none-before-message")


LOCAL = """\
def send():
    publisher = None
    publisher.publish(Twist())  # crashed

def main():
    publisher = 1
"""


def test_a_local_variable_is_not_the_modules() -> None:
    found = reported(LOCAL, "AttributeError: 'NoneType' object has no attribute 'publish'")
    assert (found.diagnosis, "global" not in found.cause) == ("none-before-message", True)
