"""A pause: the turtle stands still for a while, and then continues."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.subjects.pause import PAUSE
from grader.tests.checks.made import every, evidence, found, recording
from grader.tests.checks.shapes import TRACEBACK, crashed
from grader.tests.checks.told import told
from grader.trial.observed import Call
from grader.trial.recording import Output

if TYPE_CHECKING:
    from grader.tests.checks.made import Timed


@pytest.mark.parametrize(
    ("rest", "diagnosis"),
    [
        ((3.0, 6.0), None),
        ((3.0, 99.0), "pause-never-ends"),
        ((4.0, 6.0), "pause-ignored"),
        ((99.0, 99.0), "pause-ignored"),
    ],
)
def test_a_turtle_stands_still_and_goes_on(rest: tuple[float, float], diagnosis: str | None) -> None:
    commands = [(t_s, *((0.0, 0.0) if rest[0] <= t_s < rest[1] else (v, w))) for t_s, v, w in every(0.1, 1.0, 1.0)]
    finding = found(PAUSE, evidence(recording(commands)), from_s=3.0, until_s=6.0)
    assert finding.diagnosis == diagnosis


def test_a_pause_without_a_stop_command_is_reported() -> None:
    commands = [each for each in every(0.1, 1.0, 1.0) if not 3.0 <= each[0] < 6.0]
    assert found(PAUSE, evidence(recording(commands)), from_s=3.0, until_s=6.0).diagnosis == "no-stop-command"


def test_a_turtle_that_is_removed_for_the_pause_does_not_stand_still() -> None:
    made = recording(rests(3.1, 6.0), interventions=("kill", "spawn"))
    assert found(PAUSE, evidence(made), from_s=3.0, until_s=6.0).diagnosis == "intervention"


def rests(from_s: float, until_s: float, again_s: float = 99.0) -> list[Timed]:
    """Return commands that drive a circle, except between two times. At `again_s`, the turtle drives for 0.5 s."""
    return [
        (t_s, *((0.0, 0.0) if from_s <= t_s < until_s and not again_s <= t_s < again_s + 0.5 else (v, w)))
        for t_s, v, w in every(0.1, 1.0, 1.0)
    ]


def asked(t_s: float, *, data: bool) -> Call:
    return Call(t_s, "/pause", "std_srvs/srv/SetBool", {"data": data}, {}, t_s, by_trial=True)


def about(commands: list[Timed], calls: tuple[Call, ...] = (), goes_on: float = 1.0, **changes: Any) -> str:  # noqa: ANN401
    given = evidence(recording(commands, calls=calls, **changes))
    return told(found(PAUSE, given, from_s=3.0, until_s=6.0, goes_on=goes_on))


SILENT = [each for each in every(0.1, 1.0, 1.0) if not 3.0 <= each[0] < 6.0]
EARLY = [(0.5, 1.0, 1.0), *[each for each in every(0.1, 1.0, 1.0) if each[0] > 6.0]]
"""Commands after which the turtle stands still 1.5 s before the pause."""


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The turtle stood still and then continued.", rests(3.0, 6.0), rests(3.0, 99.0)),
        ("The turtle continues at 6 s.", rests(4.0, 6.0), rests(3.0, 6.0)),
        ("The turtle did not move in the last 1 s before the pause.", EARLY, rests(3.0, 6.0)),
        ("The turtle did not continue.", rests(3.0, 99.0), rests(3.0, 8.0)),
        ("The turtle continued after 2.0 s.", rests(3.0, 8.0), rests(3.0, 99.0)),
        ("The request with data=False ends the pause.", rests(3.0, 8.0), rests(4.0, 6.0)),
        ("The turtle was still moving 1.0 s after the call.", rests(4.0, 6.0), rests(3.3, 6.0)),
        ("The commands still move the turtle during the pause", rests(4.0, 6.0), SILENT),
        ("The turtle took 0.9 s to stop after the call.", SILENT, rests(3.0, 6.0)),
        ("Without a new command, a turtle continues for one second.", SILENT, rests(4.0, 6.0)),
    ],
)
def test_a_sentence_about_a_pause_is_true(words: str, true: list[Timed], near: list[Timed]) -> None:
    assert words in about(true)
    assert words not in about(near)


def test_a_turtle_that_need_not_continue_only_stands_still() -> None:
    still = about(rests(3.0, 99.0), goes_on=0.0)
    assert "The turtle stood still after 0.0" in still
    assert "turtle continues at" not in about(rests(4.0, 99.0), goes_on=0.0)
    assert "The turtle stood still after" not in about(rests(3.0, 99.0))


def test_a_second_call_that_ends_the_pause_is_told() -> None:
    words = "The same call arrived again at 4.0 s, while the node was paused, and the turtle drove again."
    cause = "The new state must not depend on the old state, but only on request.data."
    twice = (asked(3.0, data=True), asked(4.0, data=True))
    toggled = about(rests(3.0, 6.0, again_s=4.1), twice)
    assert words in toggled
    assert cause in toggled
    other = about(rests(3.0, 6.0, again_s=4.1), (asked(3.0, data=True), asked(4.0, data=False)))
    assert "The same call arrived again" not in other
    assert cause not in other


@pytest.mark.parametrize(("at_s", "found"), [(3.1, True), (8.0, False)])
def test_a_crash_explains_the_stop_only_if_it_came_before_the_end_of_the_pause(at_s: float, *, found: bool) -> None:
    commands = [each for each in rests(3.0, 99.0) if each[0] < at_s]
    crash = about(commands, end=crashed(at_s), sigint_t_s=at_s, stderr=Output(TRACEBACK))
    assert ("The node crashed after 3.1 s: ZeroDivisionError" in crash) == found
    assert ("The request with data=False ends the pause." in crash) != found
