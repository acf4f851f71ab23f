"""Crashes whose reason is the function of the entry point, each with a function that is nearly the same."""

from __future__ import annotations

import pytest

from grader.checks.causes.crash import crash_of
from grader.checks.causes.why_crashed import crash_finding
from grader.tests.checks.crashes import reported
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission
from grader.trial.recording import ProcessEnd

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
