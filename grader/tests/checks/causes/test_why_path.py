"""The sentences about commands that lead to a wrong path."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.causes.why_path import all_zero, radius_of_commands
from grader.tests.checks.made import evidence, recording


@pytest.mark.parametrize(
    ("commands", "words"),
    [
        ([(0.5, 0.0, 0.0), (1.0, 0.0, 0.0)], "linear.x and angular.z are 0 in every command."),
        ([(0.5, 0.0, 0.0), (1.0, 0.0, 0.1)], ""),
        ([(0.5, 0.0, 0.0), (1.0, 0.1, 0.0)], ""),
        ([], ""),
    ],
)
def test_commands_are_all_zero_or_not(commands: list[tuple[float, float, float]], words: str) -> None:
    assert all_zero(evidence(recording(commands))) == words


@pytest.mark.parametrize(
    ("linear", "angular", "words"),
    [
        ((0.0, 0.0, 0.0), (0.8, 0.0, 0.0), " angular.x does not move the turtle."),
        ((0.0, 0.0, 2.0), (0.0, 0.5, 0.0), " linear.z does not move the turtle."),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), ""),
    ],
)
def test_a_field_that_does_not_move_the_turtle_is_named(
    linear: tuple[float, float, float], angular: tuple[float, float, float], words: str
) -> None:
    still = recording([(0.5, 0.0, 0.0), (1.0, 0.0, 0.0)])
    last = replace(still.commands[-1], linear=linear, angular=angular)
    told = all_zero(evidence(replace(still, commands=(still.commands[0], last))))
    assert told == f"linear.x and angular.z are 0 in every command.{words}"


@pytest.mark.parametrize(
    ("linear", "angular", "words"),
    [
        (2.0, 1.0, "angular.z: 2.0 / 1.0 = 2.0 m."),
        (2.0, -1.0, "angular.z, without their signs: 2.0 / 1.0 = 2.0 m."),
        (-2.0, -1.0, "angular.z: -2.0 / -1.0 = 2.0 m."),
    ],
)
def test_the_quotient_in_the_sentence_about_the_radius_is_right(linear: float, angular: float, words: str) -> None:
    text = radius_of_commands(evidence(recording([(0.5, linear, angular), (1.0, linear, angular)])))
    assert text == f"The radius is linear.x divided by {words}"
