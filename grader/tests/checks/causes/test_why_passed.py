"""A function that fails because of its arguments: the line that must change is the call."""

from __future__ import annotations

import pytest

from grader.checks.causes.crash import START, crash_of
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.subjects.values import VALUES
from grader.tests.checks.crashes import CRASHED, LOOK, line_with
from grader.tests.checks.made import NODE_FILE, every, evidence, recording, submission
from grader.tests.checks.made import found as found_by
from grader.tests.checks.shapes import crashed
from grader.trial.recording import Output

SOURCE = """\
SPEED = 2{constant}

class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        {call}

    def send(self):
        pass

    {function}
        {line}  # crashed
"""
FLOAT = "AssertionError: The 'x' field must be of type 'float'"
PERIOD = "def make(self, period, callback):", "self.create_timer(period, callback)"
DRIVE = "def drive(self, speed, name='a'):", "msg.linear.x = speed"
FILL = "def fill(self, msg, speed):", "msg.linear.x = speed"


def reported(call: str, function: str, line: str, error: str, constant: str = "") -> tuple[str | None, str, int | None]:
    """Return the diagnosis, the cause and the line that the report names."""
    source = SOURCE.format(call=f"{call}  # called", function=function, line=line, constant=constant)
    numbers = line_with("# called", source), line_with(CRASHED, source)
    frames = "".join(f'  File "/ws/lib/python3.11/site-packages/{NODE_FILE}", line {each}, in x\n' for each in numbers)
    trial = recording([], end=crashed(0.5), stderr=Output(f"{START}\n{frames}    the line itself\n{error}\n"))
    given = evidence(trial, submission({NODE_FILE: source}))
    crash = crash_of(given)
    assert crash is not None
    finding = crash_finding(given, crash, "It crashed.", "It runs.")
    return finding.diagnosis, finding.cause, None if finding.where is None else finding.where.line


@pytest.mark.parametrize(
    ("call", "function", "error", "diagnosis", "words"),
    [
        (
            "self.make(self.send, 0.5)",
            PERIOD,
            "TypeError: no",
            "arguments-swapped",
            "make takes its arguments in this order: period and callback.",
        ),
        (
            "self.fill(2.0, Twist())",
            FILL,
            "AttributeError: 'float' object has no attribute 'linear'",
            "arguments-swapped",
            "fill takes its arguments in this order: msg and speed.",
        ),
        (
            "self.drive('a', 2.0)",
            DRIVE,
            FLOAT,
            "arguments-swapped",
            "drive takes its arguments in this order: speed and name.",
        ),
        ("self.drive(2)", DRIVE, FLOAT, "int-for-float", "Write the number with a decimal point."),
        ("self.drive(speed=2)", DRIVE, FLOAT, "int-for-float", "Write the number with a decimal point."),
        ("self.drive('2.0', 'a')", DRIVE, FLOAT, "string-for-number", "In quotation marks, a number is a string."),
    ],
)
def test_the_call_is_the_line_that_must_change(
    call: str, function: tuple[str, str], error: str, diagnosis: str, words: str
) -> None:
    found, cause, line = reported(call, *function, error)
    assert (found, line) == (diagnosis, 6)
    assert cause.endswith(words)


@pytest.mark.parametrize(
    ("call", "function", "error"),
    [
        ("self.make(0.5, self.send)", PERIOD, "TypeError: no"),
        ("self.make(self.send, 0.5)", ("def make(self, callback, period):", PERIOD[1]), "TypeError: no"),
        ("self.make(*both)", PERIOD, "TypeError: no"),
        ("self.fill(Twist(), 2.0)", FILL, "AttributeError: 'float' object has no attribute 'linear'"),
        ("self.fill(2.0, 3.0)", FILL, "AttributeError: 'float' object has no attribute 'linear'"),
        ("self.drive(unknown, 2.0)", DRIVE, FLOAT),
        ("self.drive(2)", (DRIVE[0], "msg.linear.x = 2"), FLOAT),
        ("self.other(2)", DRIVE, FLOAT),
    ],
)
def test_a_call_that_does_not_explain_the_exception_is_not_pointed_at(
    call: str, function: tuple[str, str], error: str
) -> None:
    _, cause, line = reported(call, *function, error)
    assert line == 12
    assert "in this order: period" not in cause
    assert "in this order: msg" not in cause


def test_a_constant_that_is_passed_is_the_line_that_must_change() -> None:
    assert reported("self.drive(SPEED)", *DRIVE, FLOAT)[2] == 1
    assert reported("self.drive(SPEED)", *DRIVE, FLOAT, ".0")[2] == 12


VALUE = """\
SPEED = 2.2{first}
class Driver(Node):
    def send(self):
        self.drive({call}){second}
        self.stop(0.0)

    def drive(self, linear, angular):
        msg.linear.x = {linear}{third}
        msg.angular.z = {angular}
"""


@pytest.mark.parametrize(
    ("call", "linear", "angular", "speeds", "diagnosis", "look"),
    [
        ("2.2, 1.0", "linear", "angular", (2.2, 1.0), "wrong-value", "second"),
        ("SPEED, 1.0", "linear", "angular", (2.2, 1.0), "wrong-value", "first"),
        ("2.0, 1.0", "SPEED", "angular", (2.2, 1.0), "wrong-value", "first"),
        ("-2.0, 1.0", "linear", "angular", (-2.0, 1.0), "wrong-sign", "second"),
        ("1.0, 2.0", "linear", "angular", (1.0, 2.0), "values-swapped", "second"),
        ("2.0, 1.0", "angular", "linear", (1.0, 2.0), "values-swapped", "third"),
        ("2.1, 1.0", "linear + 0.1", "angular", (2.2, 1.0), "wrong-value", "third"),
        ("2.1, 1.0", "linear", "angular", (2.2, 1.0), "wrong-value", "third"),
        ("unknown, 1.0", "linear", "angular", (2.2, 1.0), "wrong-value", "third"),
    ],
)
def test_a_wrong_value_is_reported_where_it_is_written(
    call: str, linear: str, angular: str, speeds: tuple[float, float], diagnosis: str, look: str
) -> None:
    marks = {name: f"  {LOOK}" if name == look else "" for name in ("first", "second", "third")}
    source = VALUE.format(call=call, linear=linear, angular=angular, **marks)
    given = evidence(recording(every(0.5, *speeds)), submission({NODE_FILE: source}))
    finding = found_by(VALUES, given, linear_x_m_s=2.0, angular_z_rad_s=1.0)
    assert (finding.diagnosis, finding.where and finding.where.line) == (diagnosis, line_with(LOOK, source))
