"""The sentences about commands that lead to a wrong path."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_path import all_zero
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
