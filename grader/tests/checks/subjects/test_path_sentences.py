"""A sentence about a circle is printed where it is true, and not for a similar trajectory."""

from __future__ import annotations

import pytest

from grader.tests.checks.made import Timed, every, evidence, finding, recording
from grader.tests.checks.shapes import SHAPES
from grader.tests.checks.told import told


@pytest.mark.parametrize(
    ("shape", "words"),
    [
        ("clockwise", "The sign of angular.z sets the direction: a positive value turns left"),
        ("teleported", "Drive the turtle only with velocity commands."),
        ("stops and goes", "The turtle stops when no command arrives for 1 s."),
        ("spiral", "The commands change. A circle needs the same command all the time."),
        ("nan", "A command contained a number that is not finite."),
        ("radius 2.2", "The radius is linear.x divided by angular.z: 2.2 / 1.0 = 2.2 m."),
    ],
)
def test_the_cause_of_one_trajectory_is_not_told_for_another(shape: str, words: str) -> None:
    others = ("clockwise", "teleported", "stops and goes", "spiral", "nan", "radius 2.2", "good")
    assert [each for each in others if words in finding("circle", evidence(SHAPES[each]())).cause] == [shape]


LATE = every(0.5, 2.0, 1.0, first_s=5.0)
SLOW = every(0.5, 1.0, 0.5)
PULSES = [(t_s, *((2.0, 1.0) if round(2.0 * t_s) % 2 else (0.0, 0.0))) for t_s, _, _ in SLOW]
UNSTEADY = [(t_s, 1.0, 0.5 + 0.0001 * t_s) for t_s, _, _ in SLOW]


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("A turtle that starts late has less time for the circle.", LATE, SLOW),
        ("turns; the first command arrived at 5.0 s.", LATE, SLOW),
        ("The commands change. A circle needs the same command all the time.", PULSES, every(2.0, 2.0, 1.0)),
        ("With angular.z = 0.5 rad/s, one turn takes 12.6 s.", SLOW, UNSTEADY),
        ("linear.x is negative, so the turtle drives backwards.", every(0.5, -2.0, -1.0), every(0.5, 2.0, -1.0)),
    ],
)
def test_a_sentence_about_a_circle_is_true(words: str, true: list[Timed], near: list[Timed]) -> None:
    assert words in told(finding("circle", evidence(recording(true))))
    assert words not in told(finding("circle", evidence(recording(near))))
