"""Crashes whose reason is the function of the entry point, each with a function that is nearly the same."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.causes.crash import START, crash_of
from grader.checks.causes.why_crashed import crash_finding
from grader.tests.checks.crashes import reported
from grader.tests.checks.made import BUILD, NODE_FILE, evidence, recording, submission
from grader.trial.recording import Output, ProcessEnd

NO_INIT = "rclpy.exceptions.NotInitializedException: rclpy.init() has not been called"
CLASS = """\
class {name}(Node):
    def __init__(self, args=None):
        super().__init__("draw_circle")  # crashed
"""


@pytest.mark.parametrize(
    ("name", "error", "told"), [("main", NO_INIT, True), ("DrawCircle", NO_INIT, False), ("main", "KeyError: 1", False)]
)
def test_an_entry_point_that_names_the_class_is_told(name: str, error: str, *, told: bool) -> None:
    found = reported(CLASS.format(name=name), error)
    words = "The entry point draw_circle names the class main. It must name the function that calls rclpy.init"
    assert (words in found.cause, found.diagnosis == "entry-point-not-callable") == (told, told)


COROUTINE = """\
import rclpy

{kind} main():
    rclpy.init()
    rclpy.spin(rclpy.create_node("draw_circle"))
"""


@pytest.mark.parametrize(("kind", "code", "told"), [("async def", 1, True), ("def", 1, False), ("async def", 3, False)])
def test_an_entry_point_that_names_a_coroutine_is_told(kind: str, code: int, *, told: bool) -> None:
    end = ProcessEnd(by="itself", exit_code=code, t_s=0.5, stop_s=None)
    given = evidence(recording([], end=end), submission({NODE_FILE: COROUTINE.format(kind=kind)}))
    crash = crash_of(given)
    assert crash is not None
    found = crash_finding(given, crash, "It crashed.", "It runs.")
    assert ("main is declared with async def, so calling it runs none of its lines." in found.cause) == told
    assert found.where is not None
    assert (found.diagnosis, found.where.line) == (("entry-point-not-callable", 3) if told else ("crash", 4))


@pytest.mark.parametrize(
    ("function", "where", "told"), [("drive", "", True), ("drive", "  # crashed", False), ("main", "", False)]
)
def test_a_function_of_the_entry_point_needs_no_arguments(function: str, where: str, *, told: bool) -> None:
    build = replace(BUILD, entry_points={"draw_circle": f"my_robot_controller.draw_circle:{function}"})
    text = f'{START}\n  File "/ws/bin/draw_circle", line 3, in a\n'
    text += f'  File "/ws/site-packages/{NODE_FILE}", line 2, in b\n' if where else ""
    end = ProcessEnd(by="itself", exit_code=1, t_s=0.5, stop_s=None)
    error = f"TypeError: {function}() missing 2 required positional arguments: 'x' and 'y'"
    trial = recording([], end=end, stderr=Output(f"{text}{error}\n"))
    given = evidence(trial, submission({NODE_FILE: f"def {function}(x, y):\n    pass\n"}), build=build)
    crash = crash_of(given)
    assert crash is not None
    cause = crash_finding(given, crash, "It crashed.", "It runs.").cause
    assert ("The entry point draw_circle names drive, which needs arguments. It must name a function" in cause) == told


THREAD = """\
import rclpy

def main():
    node = rclpy.create_node("draw_circle")
    {line}
    node.destroy_node()  # crashed
"""


@pytest.mark.parametrize(
    ("line", "error", "told"),
    [
        ("Thread(target=rclpy.spin, args=(node,)).start()", "'NoneType' object has no attribute 'handle'", True),
        ("Thread(target=rclpy.spin, args=(node,)).start()", "'NoneType' object has no attribute 'x'", False),
        ("Thread(target=print, args=(node,)).start()", "'NoneType' object has no attribute 'handle'", False),
    ],
)
def test_a_node_that_is_destroyed_while_a_thread_spins_it_is_told(line: str, error: str, *, told: bool) -> None:
    found = reported(THREAD.format(line=line), f"AttributeError: {error}")
    assert ("rclpy.spin runs in this thread. The main thread does not wait for it" in found.cause) == told
