"""A star: its sides are driven by commands, and its corners are turned by goals."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.star import STAR
from grader.tests.checks.goals import given
from grader.tests.checks.made import TICK_S, found
from grader.tests.checks.told import told

if TYPE_CHECKING:
    from grader.tests.checks.made import Timed


def star(sides: int = 5, ticks: int = 10, turn: float = 144.0, more: int = 0) -> list[tuple[float, float, float]]:
    """Return the commands of a star of 2 m, at 0.2 m per tick.

    The commands also turn the turtle, since the frames are computed from the commands.
    """
    corner = math.radians(turn) / (4 * TICK_S)
    speeds = []
    for index in range(sides):
        speeds += [(2.0 / (10 * TICK_S), 0.0)] * ticks
        speeds += [(0.0, corner)] * 4 if index < sides - 1 else [(2.0 / (10 * TICK_S), 0.0)] * more
    speeds += [(0.0, 0.0)] * 10
    return [((index + 1) * TICK_S, *speed) for index, speed in enumerate(speeds)]


@pytest.mark.parametrize(
    ("commands", "diagnosis"),
    [
        (star(), None),
        (star(sides=4), "too-few-sides"),
        (star(sides=6), "drives-on"),
        (star(ticks=8), "side-length"),
        (star(more=4), "side-length"),
        (star(turn=130.0), "corner-angle"),
        ([], "not-moving"),
    ],
)
def test_a_star_is_measured(commands: list[tuple[float, float, float]], diagnosis: str | None) -> None:
    trial = given(commands=commands, interventions=("rotate_absolute",))
    finding = found(STAR, trial, side_m=2.0, heading_deg=0.0)
    assert (finding.diagnosis, finding.status is Status.PASSED) == (diagnosis, diagnosis is None)


def test_a_star_may_be_turned_by_goals_and_not_by_teleports() -> None:
    trial = given(commands=star(), interventions=("rotate_absolute", "teleport_absolute"))
    finding = found(STAR, trial, side_m=2.0, heading_deg=0.0)
    assert finding.diagnosis == "intervention"
    assert finding.observed == "Something other than commands and goals may have moved the turtle: teleport_absolute."


def test_a_star_needs_its_first_heading() -> None:
    finding = found(STAR, given(commands=star()), side_m=2.0, heading_deg=30.0)
    assert finding.diagnosis == "corner-angle"


def about(commands: list[Timed], heading_deg: float = 0.0, **changes: Any) -> str:  # noqa: ANN401
    trial = given(commands=commands, interventions=("rotate_absolute",), **changes)
    return told(found(STAR, trial, side_m=2.0, heading_deg=heading_deg))


CURVED = [(t_s, speed, turn or 1.0) for t_s, speed, turn in star()]
LASTS = [before[0] for before, after in pairwise(star()) if before[1] and not after[1]]
CUT = sorted([*star(), *((t_s + 0.001, 0.0, 0.0) for t_s in LASTS)])
"""The zeros at the end of each side are sent in the same call as the last command of the side."""
LONG = [(t_s, 3.0 * speed, turn) for t_s, speed, turn in star()]


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The turtle drew a star of 5 sides.", star(), star(sides=4)),
        ("The trajectory has 4 sides.", star(sides=4), star()),
        ("All sides and corners must fit into the 10 s of the trial.", star(sides=4), star()),
        ("The goals turn the turtle: angular.z stays 0.", CURVED, star(ticks=8)),
        ("% of the trajectory is curved.", CURVED, star()),
        ("Side 1 is 1.60 m long.", star(ticks=8), star()),
        ("Side 2 has a heading of 130 degrees.", star(turn=130.0), star()),
        ("Side 1 is 1.80 m long.", CUT, star()),
        ("The command with zeros arrives together with the last command of the side", CUT, star(ticks=8)),
        ("Send the zeros when the timer fires the next time.", CUT, star(ticks=8)),
        ("each following side 144 degrees further to the left.", star(ticks=8), star()),
        ("The heading of a goal is absolute: 0 is to the right", star(turn=130.0), star(ticks=8)),
        ("After the last side, the turtle drives 2.0 m further.", star(sides=6), star()),
        ("After the last side, the node needs a state in which it does nothing.", star(sides=6), star(sides=4)),
        ("The turtle ran into a wall.", LONG[:60], star()),
        (
            "A side is too long, a heading is wrong, or the turtle does not stop after the last side.",
            LONG[:60],
            star(turn=130.0),
        ),
        ("The turtle did not drive.", [], star()),
    ],
)
def test_a_sentence_about_a_star_is_true(words: str, true: list[Timed], near: list[Timed]) -> None:
    assert words in about(true)
    assert words not in about(near)
