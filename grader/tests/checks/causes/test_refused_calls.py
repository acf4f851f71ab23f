"""The sentences about calls that rclpy refuses, each with a call or an error that is nearly the same."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported, to_look_at

NODE = """\
import rclpy
from rclpy.node import Node

class Pen:
    def init(self):
        pass

class Driver(Node):
    def {name}(self):
        super().{name}("driver")
        {line}  # crashed

    def send(self):
        pass

    def take(pose):
        pass

def main():
    rclpy.init()
    rclpy.spin(Driver())
"""
CALLBACK = "RuntimeError: callback should be either be callable with one argument or two"
NO_NAME = "TypeError: Node.__init__() missing 1 required positional argument: 'node_name'"


def cause(line: str, error: str, name: str = "__init__") -> str:
    return reported(NODE.format(line=line, name=name), error).cause


@pytest.mark.parametrize(
    ("line", "near", "error", "words"),
    [
        (
            "self.get_logger('x')",
            "self.get_clock('x')",
            "TypeError: Node.get_{}() takes 1 positional argument but 2 were given",
            " get_logger() returns the logger, and the methods of the logger take the text.",
        ),
        (
            "self.create_subscription(Pose, '/a', self.send, 10)",
            "self.create_subscription(Pose, '/a', print, 10)",
            CALLBACK,
            "send has no parameter for the message that a subscription passes.",
        ),
        (
            "self.create_subscription(Pose, '/a', self.take, 10)",
            "self.create_subscription(Pose, '/a', self.send, 10)",
            CALLBACK,
            "take is a method, so its first parameter is self. Write take(self, pose).",
        ),
        (
            "self.create_subscription(Pose, '/a', 'send', 10)",
            "self.create_subscription(Pose, '/a', self.send, 10)",
            CALLBACK,
            "The callback of a subscription is a function or method that takes the message.",
        ),
    ],
)
def test_a_refused_call_is_told_from_one_that_is_nearly_the_same(line: str, near: str, error: str, words: str) -> None:
    assert words in cause(line, error.format("logger"))
    assert words not in cause(near, error.format("clock"))


@pytest.mark.parametrize(
    ("error", "near", "words"),
    [
        (
            "RuntimeError: timer period must be non-negative",
            "RuntimeError: timer period is invalid",
            "The period is a time in seconds, so it cannot be negative.",
        ),
        (
            "RuntimeError: Context.init() must only be called once",
            "RuntimeError: Context.init() failed",
            "Call rclpy.init only once.",
        ),
        (
            "RuntimeError: callback should be either be callable with one argument or two",
            "RuntimeError: callback failed",
            "The callback of a subscription is a function or method that takes the message.",
        ),
    ],
)
def test_a_refusal_of_rclpy_is_known_by_its_words(error: str, near: str, words: str) -> None:
    assert words in cause("self.start()", error)
    assert words not in cause("self.start()", near)


@pytest.mark.parametrize(
    ("passed", "most", "words"),
    [
        ("1", 1, "turn takes no positional arguments. This call passes 1."),
        ("1, 2, 3", 2, "turn takes at most 1 positional argument. This call passes 3."),
        ("*numbers", 2, None),
    ],
)
def test_too_many_arguments_are_counted_without_self(passed: str, most: int, words: str | None) -> None:
    given = len(passed.split(",")) + 1
    plural = "" if most == 1 else "s"
    error = f"TypeError: Wheel.turn() takes {most} positional argument{plural} but {given} were given"
    said = cause(f"self.wheel.turn({passed})", error)
    assert (said == words) == (words is not None)
    assert ("This call passes" not in said) == (words is None)


@pytest.mark.parametrize(
    ("lines", "more"),
    [
        ("rclpy.init()\nrclpy.init()", " rclpy.init is called on lines 2 and 3."),
        ("rclpy.init(); rclpy.init()", " rclpy.init is called twice on line 2."),
        ("rclpy.init()", ""),
    ],
)
def test_the_lines_of_rclpy_init_are_told_if_there_are_several_calls(lines: str, more: str) -> None:
    given = reported(f"import rclpy\n{lines}  # crashed\n", "RuntimeError: Context.init() must only be called once")
    assert given.cause == f"Call rclpy.init only once.{more}"


INIT = (
    "class Driver(Node):\n    def {name}(self):{look}\n        super().{name}('driver')\n\nnode = Driver()  # crashed\n"
)


@pytest.mark.parametrize(
    ("name", "found"), [("init", True), ("_init_", True), ("__int__", True), ("__intit__", True), ("start", False)]
)
def test_a_misspelt_init_is_found_in_the_class_of_the_new_object(name: str, *, found: bool) -> None:
    source = INIT.format(name=name, look="  # look" if found else "")
    given = reported(source, NO_NAME)
    words = (
        f"The class has a method {name}, but only __init__ is called when an object is created. Write __init__, with "
        "two underscores on each side."
    )
    assert (given.cause == words) == found
    assert given.line == to_look_at(source)


def test_a_method_init_of_another_class_is_not_blamed() -> None:
    given = cause("super().__init__()", NO_NAME)
    assert given == "Pass the node name, a string, to super().__init__."


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ("with rclpy.init():  # crashed\n    rclpy.spin(node)\n", True),
        ("rclpy.init(); rclpy.shutdown(); rclpy.spin(node)  # crashed\n", False),
        ("rclpy.init()\nrclpy.spin(node)  # crashed\n", False),
    ],
)
def test_init_in_a_with_statement_is_told_from_other_uses(source: str, *, found: bool) -> None:
    error = "TypeError: 'NoneType' object does not support the context manager protocol"
    words = "Only newer distributions allow rclpy.init in a with statement. In Jazzy, rclpy.init returns None."
    assert (reported(f"import rclpy\n{source}", error).cause == words) == found


@pytest.mark.parametrize(
    ("init", "diagnosis"), [("rclpy.init", "not-called"), ("print(rclpy.init)", "no-init"), ("rclpy.init()", "crash")]
)
def test_an_init_that_is_only_named_is_the_reason_for_a_missing_context(init: str, diagnosis: str) -> None:
    error = "TypeError: 'NoneType' object does not support the context manager protocol"
    assert reported(f"import rclpy\n{init}\nrclpy.spin(node)  # crashed\n", error).diagnosis == diagnosis
