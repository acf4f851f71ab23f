from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.eight import EIGHT
from grader.tests.checks.made import NODE_FILE, TICK_S, every, evidence, found, legs, recording, submission
from grader.tests.checks.shapes import teleported
from grader.tests.checks.told import told
from grader.trial.recording import Pose

if TYPE_CHECKING:
    from grader.tests.checks.made import Timed

TICKS = 40
TURN = 2.0 * math.pi / (TICKS * TICK_S)  # in rad/s; a circle takes this many ticks


def lobe(side: float, radius_m: float = 1.0, degrees: float = 360.0) -> tuple[int, float, float]:
    """Return one lobe of the figure eight, to the left (+1) or to the right (-1)."""
    return round(TICKS * degrees / 360.0), radius_m * TURN, side * TURN


def eight(*parts: tuple[int, float, float], start: Pose | None = None, **values: str) -> Finding:
    return found(EIGHT, evidence(recording(legs(*parts), start)), radius_m=1.0, **values)


def test_the_requested_radius_of_the_lobes_is_not_rounded() -> None:
    wide = found(EIGHT, evidence(recording(legs(lobe(1, 1.25), lobe(-1, 1.25)))), radius_m=1.25)
    assert wide.observed == "The turtle drove a figure eight with radius 1.25 m."


def test_a_figure_eight_passes_from_any_start() -> None:
    for start in (None, Pose(4.0, 6.5, 2.2)):
        assert eight(lobe(1), lobe(-1), start=start).observed == "The turtle drove a figure eight with radius 1.0 m."


@pytest.mark.parametrize(
    ("first", "second", "clock", "diagnosis"),
    [
        (315.0, 360.0, "wall", "too-soon"),
        (315.0, 360.0, "simulated", "lobe-angle"),
        (315.0, 200.0, "wall", "lobe-angle"),
        (396.0, 360.0, "wall", "lobe-angle"),
        (360.0, 200.0, "wall", "lobe-angle"),
    ],
)
def test_in_wall_time_a_first_lobe_without_its_beginning_was_begun_before_discovery(
    first: float, second: float, clock: str, diagnosis: str
) -> None:
    observed = recording(legs(lobe(1, degrees=first), lobe(-1, degrees=second)), clock=clock)
    assert found(EIGHT, evidence(observed), radius_m=1.0).diagnosis == diagnosis


def test_a_rest_between_the_lobes_is_allowed_and_driving_on_after_them_is_not() -> None:
    assert eight(lobe(1), (5, 0.0, 0.0), lobe(-1)).status is Status.PASSED
    on = eight(lobe(1), lobe(-1), (12, TURN, -TURN))
    assert (on.status, on.diagnosis) == (Status.FAILED, "lobe-angle")
    assert "continues for 108 degrees after it was closed" in on.observed


@pytest.mark.parametrize(
    ("parts", "diagnosis", "observed"),
    [
        (
            (lobe(1), lobe(-1, radius_m=1.3)),
            "lobe-radius",
            "The second lobe, to the right, has a radius of 1.30 m: 0.30 m too large.",
        ),
        (
            (lobe(1, radius_m=0.8), lobe(-1)),
            "lobe-radius",
            "The first lobe, to the left, has a radius of 0.80 m: 0.20 m too small.",
        ),
        (
            (lobe(1, degrees=315.0), lobe(-1)),
            "lobe-angle",
            "The first lobe, to the left, is not closed: it ends 45 degrees too early.",
        ),
        (
            (lobe(1, degrees=396.0), lobe(-1)),
            "lobe-angle",
            "The first lobe, to the left, continues for 36 degrees after it was closed.",
        ),
        (
            (lobe(1), lobe(-1, degrees=180.0)),
            "lobe-angle",
            "The second lobe, to the right, is not closed: it ends 180 degrees too early.",
        ),
        ((lobe(1),), "one-lobe", "The trajectory has only one lobe, to the left."),
        ((lobe(1), lobe(1)), "one-lobe", "The trajectory has only one lobe, to the left."),
        (((20, 1.0, 0.0),), "one-lobe", "The trajectory has no lobe."),
        ((lobe(-1), lobe(1)), "wrong-side-first", "The first lobe goes to the right."),
        (
            ((20, TURN, TURN), (20, 1.5 * TURN, TURN), lobe(-1)),
            "lobe-not-round",
            "The first lobe, to the left, is not round: it deviates by 0.20 m from the best-fitting circle.",
        ),
        (
            ((5, 1.0, 0.0), lobe(1), lobe(-1)),
            "lobe-gap",
            "The first lobe, to the left, ends 0.48 m away from the start position.",
        ),
        (((5, 0.0, 0.0),), "not-moving", "The turtle did not drive."),
        ((lobe(1, radius_m=3.0), lobe(-1)), "wall", "The turtle ran into a wall."),
    ],
)
def test_each_other_trajectory_is_reported_with_its_lobe_and_by_how_much(
    parts: tuple[tuple[int, float, float], ...], diagnosis: str, observed: str
) -> None:
    finding = eight(*parts, first="left")
    assert (finding.status, finding.diagnosis, finding.observed) == (Status.FAILED, diagnosis, observed)
    assert str(finding.where) == f"{NODE_FILE}:{10 if diagnosis == 'lobe-angle' else 15}"


def test_either_side_may_come_first_where_the_exercise_allows_it() -> None:
    assert eight(lobe(-1), lobe(1), first="either").status is Status.PASSED


def test_a_trajectory_with_an_intervention_fails() -> None:
    moved = teleported(recording(legs(lobe(1), lobe(-1))))
    assert found(EIGHT, evidence(moved), radius_m=1.0).diagnosis == "intervention"
    assert found(EIGHT, evidence(recording(every(0.5, math.nan, 1.0))), radius_m=1.0).status is Status.FAILED


@pytest.mark.parametrize(
    ("radius_m", "near", "status"),
    [(1.0, False, "passed"), (1.09, True, "passed"), (1.11, True, "failed"), (1.2, False, "failed")],
)
def test_a_lobe_near_the_edge_of_its_size_is_for_wall_time_to_judge(radius_m: float, near: bool, status: str) -> None:
    finding = eight(lobe(1), lobe(-1, radius_m=radius_m))
    assert (finding.near_edge, finding.status.value) == (near, status)


@pytest.mark.parametrize(
    ("parts", "off", "per_s"),
    [
        ((lobe(1, degrees=315.0), lobe(-1)), 33.0, math.degrees(TURN)),
        ((lobe(1, degrees=396.0), lobe(-1)), 24.0, math.degrees(TURN)),
        (((5, 1.0, 0.0), lobe(1), lobe(-1)), 0.28, TURN),
    ],
)
def test_what_stalls_of_the_machine_may_have_done_is_not_judged(
    parts: tuple[tuple[int, float, float], ...], off: float, per_s: float
) -> None:
    for share, status in ((1.02, Status.ERROR), (0.98, Status.FAILED)):
        stalled = recording(legs(*parts), clock="wall", stalls=((1.0, 1.0 + share * off / per_s),))
        assert found(EIGHT, evidence(stalled), radius_m=1.0).status is status


@pytest.mark.parametrize(("ticks", "diagnosis"), [(1, None), (3, "wrong-side-first")])
def test_a_small_bend_is_no_lobe(ticks: int, diagnosis: str | None) -> None:
    assert eight((ticks, TURN, -TURN), lobe(1), lobe(-1), first="left").diagnosis == diagnosis


Part = tuple[int, float, float]


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The lobes are too large.", (lobe(1, radius_m=3.0), lobe(-1)), ((60, 2.0, 0.0), lobe(1))),
        ("The turtle drove straight into the wall.", ((60, 2.0, 0.0), lobe(1)), (lobe(1, radius_m=3.0), lobe(-1))),
        ("The turtle ran into a wall.", ((20, 3.0, 0.0), lobe(-1), lobe(1)), ((5, 3.0, 0.0), lobe(-1), lobe(1))),
        (
            "A full circle takes 2 pi / abs(angular.z) seconds.",
            (lobe(1, degrees=315.0), lobe(-1)),
            (lobe(1, 1.3), lobe(-1)),
        ),
        ("The radius is linear.x divided by angular.z.", (lobe(1, 1.3), lobe(-1)), (lobe(1, degrees=315.0), lobe(-1))),
        (
            "After the second lobe, the turtle must stand still. Publish a",
            (lobe(1), lobe(-1, degrees=470.0)),
            (lobe(1), lobe(-1)),
        ),
        (
            "After the second lobe, the turtle drives a third one, to the left.",
            (lobe(1), lobe(-1), lobe(1, degrees=90.0)),
            (lobe(1), lobe(-1)),
        ),
        (
            "After two lobes, the turtle must stand still. Publish a",
            (lobe(1), lobe(-1), lobe(1, degrees=90.0)),
            (lobe(1), lobe(-1, degrees=470.0)),
        ),
        ("When the first lobe is closed, the sign of angular.z must change", (lobe(1),), (lobe(1), lobe(-1))),
    ],
)
def test_a_sentence_about_an_eight_is_true(words: str, true: tuple[Part, ...], near: tuple[Part, ...]) -> None:
    assert words in told(eight(*true))
    assert words not in told(eight(*near))


def test_a_wall_beside_a_lobe_of_the_right_size_says_nothing_about_its_size() -> None:
    beside = eight(lobe(1), lobe(-1), start=Pose(10.6, 5.5, 0.0))
    assert (beside.diagnosis, beside.cause) == ("wall", "")


@pytest.mark.parametrize(("speed", "found"), [(0.05, True), (0.5, False)])
def test_a_small_speed_at_the_end_is_told(speed: float, *, found: bool) -> None:
    commands = [*legs(lobe(1), lobe(-1), rest_s=8.2), *every(0.1, speed, 0.0, first_s=8.3)]
    given = told(found_eight(commands))
    assert f"The turtle still drives at {speed:.2f} m/s at the end of the 10 s of the trial." in given
    assert ("Small speeds are not 0. Publish a command with all values 0" in given) == found


def found_eight(commands: list[Timed]) -> Finding:
    return found(EIGHT, evidence(recording(commands)), radius_m=1.0)


def test_a_last_command_that_is_not_zero_is_told() -> None:
    words = "The last command has values other than 0. The turtle stopped only because no more commands arrived."
    driving = [each for each in legs(lobe(1), lobe(-1)) if each[1]]
    last_s = driving[-1][0]
    nearly = [*driving[:-1], (last_s, 1e-2, 0.0)]
    assert words in told(found_eight(nearly))
    assert words not in told(found_eight([*nearly, (last_s + TICK_S, 0.0, 0.0)]))


@pytest.mark.parametrize(("times", "found_"), [(180.0 / math.pi, True), (50.0, False)])
def test_a_lobe_in_degrees_is_told(times: float, *, found_: bool) -> None:
    parts = legs((TICKS, times * TURN, times * TURN), (TICKS, times * TURN, -times * TURN))
    given = told(found(EIGHT, evidence(recording(parts)), radius_m=1.0, radius_tolerance_m=0.3))
    words = "angular.z is in radians per second, and a full circle is 2 pi radians, not 360."
    assert "after it was closed" in given
    assert (words in given) == found_


@pytest.mark.parametrize(("operator", "found_"), [("=+", True), ("+=", False)])
def test_a_counter_that_stays_the_same_is_told(operator: str, *, found_: bool) -> None:
    source = f"class Eight:\n    def step(self):\n        self.ticks {operator} 1\n"
    given = evidence(recording(legs(lobe(1, degrees=720.0))), submission({NODE_FILE: source}))
    reported = told(found(EIGHT, given, radius_m=1.0))
    assert ("=+ sets self.ticks to 1 in each call. += adds." in reported) == found_
    assert ("the sign of angular.z must change for the second one." in reported) != found_
