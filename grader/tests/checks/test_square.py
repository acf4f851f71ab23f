from __future__ import annotations

import math

import pytest

from grader.checks.square import SQUARE
from grader.outcome import Finding, Status
from grader.recording import Pose
from grader.tests.checks.made import NODE_FILE, TICK_S, evidence, found, legs, recording

TICKS = 10
Leg = tuple[int, float, float]


def side(length_m: float = 2.0) -> Leg:
    return TICKS, length_m / (TICKS * TICK_S), 0.0


def corner(degrees: float = 90.0) -> Leg:
    return TICKS, 0.0, math.radians(degrees) / (TICKS * TICK_S)


def round_(sides: tuple[float, ...] = (2.0,) * 4, corners: tuple[float, ...] = (90.0,) * 4) -> list[Leg]:
    """Side, corner, side, ..."""
    return [leg for length, turn in zip(sides, corners, strict=True) for leg in (side(length), corner(turn))]


def square(parts: list[Leg], start: Pose | None = None, **values: str) -> Finding:
    return found(SQUARE, evidence(recording(legs(*parts), start)), side_m=2.0, **values)


@pytest.mark.parametrize(
    "parts",
    [
        round_(),
        round_()[:-1],
        [*round_()[1:], side()],  # begins with a corner
        [leg for part in round_() for leg in (part, (3, 0.0, 0.0))],  # rests in between
    ],
)
@pytest.mark.parametrize("start", [None, Pose(6.0, 5.0, 1.2)])
def test_a_square_is_one(parts: list[Leg], start: Pose | None) -> None:
    assert square(parts, start).seen == "The turtle drove a square of 2.0 m."


@pytest.mark.parametrize(
    ("parts", "diagnosis", "seen"),
    [
        (round_((2.0, 2.0, 2.3, 2.0)), "side-length", "The third side is 2.30 m long: 0.30 m too long."),
        (round_((2.0, 1.5, 2.0, 2.0)), "side-length", "The second side is 1.50 m long: 0.50 m too short."),
        (round_(corners=(90.0, 60.0, 90.0, 90.0)), "corner-angle", "The second corner turns by 60 degrees."),
        (round_(corners=(105.0,) * 4), "corner-angle", "The first corner turns by 105 degrees."),
        (round_(corners=(90.0, -90.0, 90.0, 90.0)), "corner-angle", "The second corner turns by -90 degrees."),
        (round_(corners=(-90.0,) * 4), "wrong-sense", "The turtle turns to the wrong side at its corners."),
        (round_()[:5], "too-few-sides", "The way has 3 sides."),
        ([side()], "too-few-sides", "The way has 1 side."),
        (
            [leg for _ in range(4) for leg in (side(), (TICKS, 0.5, math.pi / 2 / (TICKS * TICK_S)))],
            "curves",
            "19 % of the way are curves.",
        ),
        ([(5, 0.0, 0.0)], "not-moving", "The turtle did not drive."),
        (round_((7.5, 2.0, 2.0, 2.0)), "wall", "The turtle ran into a wall."),
        (
            round_((2.1, 2.1, 1.9, 1.9), (96.0, 96.0, 96.0, 90.0)),
            "square-gap",
            "The fourth side ends 0.62 m beside the start.",
        ),
    ],
)
def test_each_other_way_is_told_with_its_side_or_corner_and_by_how_much(
    parts: list[Leg], diagnosis: str, seen: str
) -> None:
    finding = square(parts, Pose(4.0, 4.0, 0.0))
    assert (finding.status, finding.diagnosis, finding.seen) == (Status.FAILED, diagnosis, seen)
    assert str(finding.where) == f"{NODE_FILE}:16"


def test_clockwise_is_right_where_the_exercise_allows_it() -> None:
    left, right = round_(), round_(corners=(-90.0,) * 4)
    assert square(right, sense="either").status is Status.PASSED
    assert square(right, sense="clockwise").status is Status.PASSED
    assert square(left, sense="clockwise").diagnosis == "wrong-sense"


def test_a_way_that_was_driven_by_other_means_is_none() -> None:
    moved = recording(legs(*round_()), interventions=("teleport_relative",))
    assert found(SQUARE, evidence(moved), side_m=2.0).diagnosis == "intervention"


@pytest.mark.parametrize(
    ("length", "near", "status"),
    [(2.0, False, "passed"), (2.13, True, "passed"), (2.17, True, "failed"), (2.5, False, "failed")],
)
def test_a_side_near_the_edge_is_for_wall_time_to_judge(length: float, near: bool, status: str) -> None:
    finding = square(round_((2.0, length, 2.0, 2.0)))
    assert (finding.near_edge, finding.status.value) == (near, status)
