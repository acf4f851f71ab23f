from __future__ import annotations

import math
from dataclasses import replace

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.goal import GOAL
from grader.tests.checks.made import NODE, NODE_FILE, TICK_S, evidence, found, legs, recording, submission
from grader.tests.checks.shapes import TRACEBACK, crashed, teleported
from grader.trial.recording import Output, Pose

Leg = tuple[int, float, float]
START = Pose(3.0, 5.0, 0.0)
"""The goal is 4 m east of the start."""
QUARTER = math.pi / 2 / (10 * TICK_S)


def ahead(length_m: float, ticks: int = 20) -> Leg:
    return ticks, length_m / (ticks * TICK_S), 0.0


def goal(*parts: Leg, start: Pose = START, stops: bool = True, code: str = "GOAL = 7.0, 5.0") -> Finding:
    given = recording(legs(*parts) if stops else legs(*parts, rest_s=0.0), start)
    return found(GOAL, evidence(given, submission({NODE_FILE: f"{NODE}\n{code}\n"})), x_m=7.0, y_m=5.0)


@pytest.mark.parametrize("length_m", [4.0, 3.95, 4.05])
def test_a_turtle_that_stops_within_the_tolerance_has_arrived(length_m: float) -> None:
    finding = goal(ahead(length_m))
    assert (finding.status, finding.observed) == (
        Status.PASSED,
        "The turtle drove to its goal, 4.0 m away, and stopped.",
    )


@pytest.mark.parametrize(
    ("parts", "diagnosis", "observed"),
    [
        ((ahead(3.0),), "not-there", "The turtle ends at x=6.00 y=5.00, 1.00 m from the goal."),
        (
            (ahead(6.0, 30),),
            "goes-on",
            (
                "The turtle ends at x=9.00 y=5.00, 2.00 m from the goal. "
                "On the way, the turtle came within 0.00 m of the goal."
            ),
        ),
        ((ahead(-2.0),), "not-there", "The turtle ends at x=1.00 y=5.00, 6.00 m from the goal."),
        (
            ((10, 0.0, QUARTER), ahead(7.0)),
            "not-there",
            "The turtle ends at x=3.00 y=11.09, 7.29 m from the goal.",
        ),
        (((5, 0.0, 0.0),), "not-moving", "The turtle did not drive."),
        (
            (ahead(3.92, 90), (20, 0.05, 0.0)),
            "still-moving",
            "The turtle still drives at 0.05 m/s at the end of the 10 s of the trial.",
        ),
    ],
)
def test_a_turtle_that_is_not_at_the_goal_is_reported_with_its_place(
    parts: tuple[Leg, ...], diagnosis: str, observed: str
) -> None:
    finding = goal(*parts)
    assert (finding.status, finding.diagnosis, finding.observed) == (Status.FAILED, diagnosis, observed)
    assert str(finding.where) == f"{NODE_FILE}:16"


def test_a_turtle_that_is_no_nearer_in_the_end_has_driven_away_and_no_wall_is_named_without_one() -> None:
    assert goal(ahead(1.0), ahead(-0.97), stops=False).diagnosis == "away-from-goal"
    nearer = goal(ahead(1.0), ahead(-0.3), stops=False)
    assert (nearer.diagnosis, "wall" in nearer.cause) == ("not-there", False)


@pytest.mark.parametrize(("turns", "words"), [(1, "by 1 full turn in total"), (2, "by 2 full turns in total")])
def test_full_turns_on_the_spot_are_counted(turns: int, words: str) -> None:
    assert words in goal((60, 0.0, 1.1 * turns * math.tau / (60 * TICK_S))).cause


SWAY = QUARTER / 3
SWAYING = tuple((1, 0.5, side * 10 * SWAY) for side in (0.5, *(1.0, -1.0) * 5))


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        (SWAYING, "The turtle sways: many commands turn it in the opposite direction to the command before."),
        ((ahead(1.0, 100),), "The turtle was still getting nearer to the goal at the end of the trial"),
        ((ahead(2.0), ahead(-1.0)), "The turtle came within 2.00 m of the goal at 2.0 s, and no nearer after that."),
    ],
)
def test_a_turtle_that_does_not_arrive_is_described_by_its_way(parts: tuple[Leg, ...], words: str) -> None:
    assert words in goal(*parts, stops=False).cause


@pytest.mark.parametrize(("length_m", "diagnosis"), [(3.0, "crash"), (4.0, None)])
def test_a_crash_on_the_way_is_the_cause(length_m: float, diagnosis: str | None) -> None:
    given = replace(recording(legs(ahead(length_m)), START), end=crashed(5.0), stderr=Output(TRACEBACK))
    finding = found(GOAL, evidence(given), x_m=7.0, y_m=5.0)
    assert finding.diagnosis == diagnosis
    if diagnosis is not None:
        assert finding.observed.startswith("The turtle ends at x=6.00 y=5.00, 1.00 m from the goal. The node crashed")


def test_a_turtle_that_was_as_near_before_is_not_getting_nearer() -> None:
    again = goal(ahead(3.0, 40), ahead(-2.0), ahead(1.5, 40), stops=False)
    assert "getting nearer" not in again.cause
    assert "The turtle came within 1.0" in again.cause


@pytest.mark.parametrize("stops", [True, False])
@pytest.mark.parametrize(
    ("code", "unknown"), [("GOAL = 3.0, 9.0", True), ("GOAL = 7, 9", False), ("GOAL = 3.0, 5.0", False)]
)
def test_a_node_whose_code_contains_no_coordinate_of_the_goal_does_not_know_it(
    code: str, *, stops: bool, unknown: bool
) -> None:
    cause = goal(ahead(3.0), stops=stops, code=code).cause
    assert (cause == "The code contains neither 7 nor 5, the coordinates of the goal.") == unknown


def test_a_node_that_stops_somewhere_else_has_another_goal() -> None:
    other = "GOAL = 6.0, 5.0"
    assert "the position of the goal" in goal(ahead(3.0), code=other).cause
    assert "the position of the goal" not in goal(ahead(3.0), stops=False, code=other).cause


def test_the_cause_for_a_turtle_that_drives_into_a_wall_mentions_angles() -> None:
    finding = goal((10, 0.0, -QUARTER / 3), ahead(6.0), start=Pose(1.0, 1.0, 0.0), stops=False)
    assert (finding.diagnosis, "atan2(sin(error), cos(error))" in finding.cause) == ("not-there", True)


def test_a_turtle_that_was_put_there_has_not_driven() -> None:
    moved = teleported(recording(legs(ahead(4.0)), START), at_s=0.0)
    assert found(GOAL, evidence(moved), x_m=7.0, y_m=5.0).diagnosis == "intervention"


@pytest.mark.parametrize(
    ("length_m", "near", "status"),
    [(4.0, False, "passed"), (4.09, True, "passed"), (3.89, True, "failed"), (3.0, False, "failed")],
)
def test_an_end_near_the_edge_is_for_wall_time_to_judge(length_m: float, near: bool, status: str) -> None:
    finding = goal(ahead(length_m))
    assert (finding.near_edge, finding.status.value) == (near, status)
