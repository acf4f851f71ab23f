"""The reasons why a student's tests fail on the correct node, each with a message that is nearly the same."""

from __future__ import annotations

import re

import pytest

from grader.checks.causes.why_rejected import own_copy, why_rejected, why_wrong_tests
from grader.submission.pytest_files import read_test_code
from grader.testbench.result import NodeRun

FILE = "test/test_guard.py"
CODE = read_test_code({FILE: b"def test_it(bench):\n    assert bench\n"}, "my_package")


def cause(message: str, *, over: bool = False) -> str:
    run = NodeRun("", None if over else 1, over=over, test=f"{FILE}::test_it", outcome="failed", message=message)
    return why_rejected(run, CODE).text


@pytest.mark.parametrize(
    ("message", "near", "words"),
    [
        (
            "E   RuntimeError: Context.init() must only be called once",
            "E   RuntimeError: Context.init() failed",
            "rclpy.init was called twice without rclpy.shutdown in between. In a fixture, call rclpy.init before",
        ),
        (
            "E   rclpy.exceptions.NotInitializedException: no init",
            "E   InitializedException: no",
            "A node can exist only between rclpy.init and rclpy.shutdown. In a fixture, call rclpy.init before the",
        ),
        (
            "E   _tkinter.TclError: no display name and no $DISPLAY environment variable",
            ">   assert DISPLAY == 3\nE   AssertionError: assert 4 == 3",
            "A test must also run without a display and without a network.",
        ),
        (
            "E   ImportError: cannot import name 'SPEED' from 'my_robot_controller.wall_guard' (/ws/wall_guard.py)",
            "E   ImportError: cannot import name 'PI' from 'math' (unknown location)",
            "Only the class is promised, not SPEED. Write your numbers into the tests.",
        ),
        (
            "E   ModuleNotFoundError: No module named 'ament_flake8'",
            "E   ModuleNotFoundError: No module named 'flake8'",
            "The file needs ament_flake8, which the grader does not have. `ros2 pkg create` writes such files;",
        ),
        (
            "E   rclpy._rclpy_pybind11.RCLError: Failed to create subscription: invalid allocator",
            "E   rclpy._rclpy_pybind11.RCLError: Failed to create timer",
            "A topic has one type. Does the test subscribe with the type with which the node publishes?",
        ),
        (
            "rclpy._rclpy_pybind11.RCLError: Failed to create publisher: create_publisher() called for existing topic",
            "assert 4 == 3",
            "A topic has one type. Does the test publish with the type to which the node subscribes?",
        ),
        (
            "TypeError: type must be an instance of '<enum 'Type'>'",
            "assert 4 == 3",
            'The second argument of Parameter is the type. Name the value: Parameter("use_sim_time", value=True).',
        ),
        (
            "TypeError: 'Parameter' object is not iterable",
            "assert 4 == 3",
            "set_parameters takes a list. Write brackets around the parameter: set_parameters([Parameter(...)]).",
        ),
        (
            "Failed: async def functions are not natively supported.",
            "Failed: def functions",
            "pytest does not run functions that are defined with async def. Write def.",
        ),
        (
            "E   fixture 'bench' not found",
            "E   AssertionError: not found",
            "No fixture is named bench. Does a function with this name have the decorator pytest.fixture?",
        ),
        (
            "E   AssertionError: The 'x' field must be of type 'float'",
            "E   AssertionError: The 'x' field is not 1.0",
            "The field x is a float. Write the number with a decimal point.",
        ),
        (
            "Failed: fixture function has more than one 'yield':",
            "Failed: fixture function",
            "A fixture has one yield. The lines before it prepare the object, and the lines after it clean up.",
        ),
        (
            "OSError: pytest: reading from stdin while output is captured! Consider using `-s`.",
            "assert reading == 3",
            "A test runs without a person, so nobody types an answer. Remove this call.",
        ),
        (
            "assert 1.1 == <function approx at 0x7f0>",
            "assert 1.1 == 1.2 ± 1.2e-06",
            "approx is a function, and the test compares the function itself. Call it: approx(...).",
        ),
        (
            "E   assert <built-in method count of list object at 0x7f0> == 10",
            "E   assert 9 == 10\nE    +  where 9 = <built-in method count of list object at 0x7f0>(3)",
            "count is a function, and the test compares the function itself. Call it: count(...).",
        ),
        (
            "assert <bound method Bench.count of <Bench object at 0x7f0>> == 10",
            "assert <Bench object at 0x7f0> == 10",
            "count is a function, and the test compares the function itself. Call it: count(...).",
        ),
    ],
)
def test_the_message_of_pytest_decides(message: str, near: str, words: str) -> None:
    assert cause(message).startswith(words)
    text = "Compare the test with the promises in wall_guard.py. Does the test give the node enough time?"
    raises = "The code of the test raises this exception itself, so no assert has failed."
    raised = "AssertionError" not in near and re.match(r"E   \S+(Error|Exception):", near)
    assert cause(near).startswith(raises if raised else text)


@pytest.mark.parametrize("over", [True, False])
def test_only_tests_that_did_not_end_need_a_deadline(*, over: bool) -> None:
    words = "If a loop in a test waits for a message, give the loop a deadline. Do not call rclpy.spin in a test,"
    assert over == cause("", over=over).startswith(words)


@pytest.mark.parametrize(
    ("message", "told"),
    [
        ("assert [] is []", True),
        ("E   AssertionError: assert 1.1 is 1.1", True),
        ("assert 1.1 is None", False),
        ("assert 1.1 is not 1.1", False),
        ("assert 1.1 == 1.1", False),
    ],
)
def test_is_compares_objects(message: str, *, told: bool) -> None:
    run = NodeRun("", 1, over=False, test=f"{FILE}::test_it", outcome="failed", message=message)
    found = why_wrong_tests(run, CODE, "WallGuard")
    assert (found is not None and found.text == "is compares two objects, not their values. Write == instead.") == told


@pytest.mark.parametrize(("name", "told"), [("WallGuard", True), ("Bench", False)])
def test_a_class_of_the_tests_is_not_the_node(name: str, *, told: bool) -> None:
    code = read_test_code({FILE: f"class {name}:\n    pass\n\ndef test_it():\n    assert {name}\n".encode()}, "a")
    run = NodeRun("", 1, over=False, test=f"{FILE}::test_it", outcome="failed", message="assert 1 == 2")
    words = "The tests define their own class WallGuard, so they do not test the node. Import the class."
    for found in (own_copy(code, "WallGuard"), why_wrong_tests(run, code, "WallGuard")):
        assert (found is not None and found.text == words) == told


@pytest.mark.parametrize(("exit_code", "name", "refuses"), [(4, "", True), (4, FILE, False), (3, "", False)])
def test_an_option_that_pytest_refuses_is_not_a_wrong_test(exit_code: int, name: str, *, refuses: bool) -> None:
    text = why_rejected(NodeRun("", exit_code, test=name), CODE).text
    assert text.startswith("pytest refuses an option in pytest.ini, setup.cfg or pyproject.toml") == refuses
