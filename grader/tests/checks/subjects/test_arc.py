"""An arc: a part of the trajectory, in its colour and time."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.arc import ARC
from grader.tests.checks.made import NODE_FILE, every, evidence, found, recording, submission
from grader.tests.checks.parameter_calls import was_set
from grader.tests.checks.shapes import TRACEBACK, crashed
from grader.tests.checks.told import told
from grader.trial.observed import Call, PenChange
from grader.trial.recording import Output

if TYPE_CHECKING:
    from grader.checks.outcome import Finding
    from grader.tests.checks.made import Timed
    from grader.trial.recording import ProcessEnd


@pytest.mark.parametrize(
    ("values", "diagnosis"),
    [
        ({"radius_m": 2.0}, None),
        ({"radius_m": 1.5}, "wrong-radius"),
        ({"radius_m": 2.0, "speed_m_s": 2.0}, None),
        ({"radius_m": 2.0, "speed_m_s": 1.5}, "wrong-speed"),
        ({"radius_m": 2.0, "direction": "clockwise"}, "wrong-direction"),
        ({"radius_m": 2.0, "red": 200.0, "green": 0.0, "blue": 0.0}, None),
        ({"radius_m": 2.0, "red": 0.0, "green": 0.0, "blue": 0.0}, "not-in-colour"),
        ({"radius_m": 2.0, "angle_deg": 165.0, "until_s": 3.0}, None),
        ({"radius_m": 2.0, "angle_deg": 90.0, "until_s": 3.0}, "wrong-angle"),
    ],
)
def test_an_arc_is_measured_in_its_colour_and_time(values: dict[str, Any], diagnosis: str | None) -> None:
    pens = (PenChange(0.0, "turtle1", (200, 0, 0), 4, down=True),)
    finding = found(ARC, evidence(recording(every(0.1, 2.0, 1.0), pens=pens)), **values)
    assert (finding.diagnosis, finding.status is Status.PASSED) == (diagnosis, diagnosis is None)


CRASHED = crashed(10.0)
RED = {"radius_m": 1.0, "red": 200.0, "green": 0.0, "blue": 0.0}
CIRCLE = every(0.1, 2.0, 1.0)
WIDE = every(0.1, 2.0, 0.5)
"""A circle with a radius of 4 m, which touches a wall."""
WIDER = [*every(0.1, 1.0, 1.0, until_s=2.0), *every(0.1, 1.0, 0.5, first_s=2.1)]
"""A circle with a radius of 1 m, and another one with a radius of 2 m to the same side from t = 2.1 s on."""


def pen(t_s: float, red: int = 200, *, down: bool = True) -> PenChange:
    return PenChange(t_s, "turtle1", (red, 0, 0), 4, down=down)


def about(commands: list[Timed], pens: tuple[PenChange, ...] = (), **values: Any) -> str:  # noqa: ANN401
    return told(found(ARC, evidence(recording(commands, pens=pens)), **{"radius_m": 2.0, **values}))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("Nothing was drawn in the colour 200, 0, 0.", (), (pen(9.95),)),
        ("Almost nothing was drawn in the colour 200, 0, 0.", (pen(9.95),), ()),
        ("The pen must have this colour before the turtle moves", (), (pen(0.0), pen(5.0, 0), pen(6.0))),
        (
            "The turtle drew with the colour 200, 0, 0, then with another colour, and then with the first colour",
            (pen(0.0), pen(5.0, 0), pen(6.0)),
            (pen(0.0), pen(5.0, down=False), pen(6.0)),
        ),
        (
            "The turtle drew with the colour 200, 0, 0, then without this colour, and then with the first colour",
            (pen(0.0), pen(5.0, down=False), pen(6.0)),
            (pen(0.0), pen(5.0, 0), pen(6.0)),
        ),
        (
            "Does the node start again after its last arc? In its last state, the node must send only zeros.",
            (pen(0.0), pen(5.0, 0), pen(6.0)),
            (pen(0.0), pen(5.0, 0)),
        ),
    ],
)
def test_a_sentence_about_the_colour_of_an_arc_is_true(
    words: str, true: tuple[PenChange, ...], near: tuple[PenChange, ...]
) -> None:
    assert words in about(CIRCLE, true, **RED)
    assert words not in about(CIRCLE, near, **RED)


def test_the_colour_is_only_told_if_it_is_required() -> None:
    wanted = "The turtle drives an arc with a radius of 1 m, counter-clockwise, drawn in the colour 200, 0, 0."
    assert wanted in about(CIRCLE, (pen(0.0),), **RED)
    assert "drawn in the colour" not in about(CIRCLE, (pen(0.0),), radius_m=1.0)


PART = "A part of this arc was drawn in a different colour."
LATE_PEN = "The pen must have this colour before the turtle moves: wait for the response before you drive."


EARLY_PEN = "The pen changed before the end of this arc. Ask for the next pen when the arc is complete."


@pytest.mark.parametrize(
    ("commands", "pens", "radius_m", "why"),
    [
        (CIRCLE, (pen(0.0), pen(2.1, 0)), 2.0, EARLY_PEN),
        (CIRCLE, (pen(0.0, 0), pen(2.1), pen(5.0, 0)), 2.0, LATE_PEN),
        (WIDER, (pen(0.0), pen(2.1, 0)), 1.0, None),
        (CIRCLE, (pen(0.0), pen(2.1, down=False)), 2.0, None),
    ],
)
def test_an_arc_in_two_colours_is_told_from_two_arcs(
    commands: list[Timed], pens: tuple[PenChange, ...], radius_m: float, why: str | None
) -> None:
    given = about(commands, pens, angle_deg=300.0, **{**RED, "radius_m": radius_m})
    assert (PART in given) == (why is not None)
    assert [each for each in (LATE_PEN, EARLY_PEN) if each in given] == ([] if why is None else [why])
    assert ("This arc has an angle of " in given) == (why is None)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("This part of the path is not a single arc: it deviates by", WIDER, CIRCLE),
        ("The command or the pen changes during this part of the path.", WIDER, WIDE),
        ("The turtle ran into a wall after ", WIDE, WIDER),
        ("The radius of this arc is 1.00 m.", every(0.1, 1.0, 1.0), CIRCLE),
        ("The turtle drove in a straight line.", every(0.1, 0.2, 0.0), CIRCLE),
        ("The turtle's position became NaN", [*CIRCLE, (9.9, math.nan, 1.0)], CIRCLE),
        ("The turtle did not drive in the time that this check judges.", [], every(0.1, 0.001, 0.0005)),
        ("The turtle hardly drove in the time that this check judges.", every(0.1, 0.001, 0.0005), []),
    ],
)
def test_a_sentence_about_the_path_of_an_arc_is_true(words: str, true: list[Timed], near: list[Timed]) -> None:
    assert words in about(true)
    assert words not in about(near)


@pytest.mark.parametrize(("until_s", "found"), [(9.0, False), (600.0, True)])
def test_an_arc_that_does_not_end_is_told(until_s: float, *, found: bool) -> None:
    given = about(CIRCLE, angle_deg=90.0, until_s=until_s)
    assert "This arc has an angle of 5" in given
    assert ("degrees, and the turtle was still driving it at the end." in given) == found
    assert ("The state must change after the last timer call of this arc." in given) == found


NOT_FOLLOWED = "The parameter was set, but the commands did not change."


@pytest.mark.parametrize(
    ("commands", "found"),
    [
        (CIRCLE, True),
        ([*every(0.1, 2.0, 1.0, until_s=3.0), *every(0.1, 2.2, 1.0, first_s=3.3)], False),
        (every(0.1, 2.0, 1.0, first_s=3.6), False),
        ([each for each in CIRCLE if each[0] < 3.0], False),
    ],
)
def test_commands_that_did_not_follow_a_parameter_are_told(commands: list[Timed], *, found: bool) -> None:
    result = {"results": [{"successful": True, "reason": ""}]}
    call = Call(3.0, "/node/set_parameters", "", {"parameters": []}, result, 3.0, by_trial=True)
    given = told(found_arc(commands, call))
    assert (NOT_FOLLOWED in given) == found
    assert ("Read the parameter with get_parameter before each command." in given) == found


STORES = """\
class Circle(Node):
    def __init__(self):
        self.add_on_set_parameters_callback(self.check)

    def check(self, parameters):
        self.radius = parameters[0].value
        return SetParametersResult(successful=False, reason="too large")
"""


@pytest.mark.parametrize(("t_s", "accepted", "found_"), [(1.2, False, True), (1.2, True, False), (1.6, False, False)])
def test_values_that_were_stored_before_the_refusal_are_told_only_after_a_refusal(
    t_s: float, *, accepted: bool, found_: bool
) -> None:
    result = {"results": [{"successful": accepted, "reason": "too large"}]}
    call = Call(t_s, "/node/set_parameters", "", {"parameters": []}, result, t_s, by_trial=True)
    turns = [*every(0.1, 1.0, 1.0, until_s=3.0), *every(0.1, 1.0, -1.0, first_s=3.1)]
    given = evidence(recording(turns, calls=(call,)), submission({NODE_FILE: STORES}))
    finding = found(ARC, given, radius_m=1.0, from_s=1.4)
    assert "This part of the path is not a single arc" in finding.observed
    assert ("check stores new values in self before it refuses them." in finding.cause) == found_


def found_arc(commands: list[Timed], call: Call) -> Finding:
    return found(ARC, evidence(recording(commands, calls=(call,))), radius_m=1.0, from_s=3.4)


@pytest.mark.parametrize(("degrees", "end"), [(90.0, CRASHED), (900.0, CRASHED), (90.0, None)])
def test_an_arc_that_a_crash_cut_off_or_did_not_end_is_the_fault_of_the_crash(
    degrees: float, end: ProcessEnd | None
) -> None:
    changes: dict[str, Any] = {"end": end, "stderr": Output(TRACEBACK)} if end is not None else {}
    finding = found(ARC, evidence(recording(CIRCLE, **changes)), radius_m=2.0, angle_deg=degrees)
    assert (finding.diagnosis == "drives-on") == (end is None)
    assert ("crashed" in finding.observed) == (end is not None)


@pytest.mark.parametrize(("successful", "diagnosis"), [(True, "parameter-not-followed"), (False, "wrong-radius")])
def test_a_path_that_does_not_follow_a_parameter_is_named(successful: bool, diagnosis: str) -> None:
    given = evidence(recording(every(0.1, 2.0, 1.0), calls=(was_set(1.0, successful=successful, reason="no"),)))
    assert found(ARC, given, radius_m=1.0, from_s=3.4).diagnosis == diagnosis


def test_the_next_change_at_the_end_of_an_arc_does_not_hide_the_cause() -> None:
    commands = [*every(0.1, 2.0, 1.0, until_s=6.0), *every(0.1, 2.0, 2.0, first_s=6.0)]
    calls = (was_set(1.0, successful=True, reason=""), replace(was_set(1.0, successful=True, reason=""), t_s=6.0))
    given = evidence(recording(commands, calls=calls))
    assert found(ARC, given, radius_m=1.0, from_s=3.4, until_s=6.0).diagnosis == "parameter-not-followed"
