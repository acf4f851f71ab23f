"""Test which movements count as interventions.

Whether a movement counts depends on the movement and not on the service that was called.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from grader.evidence.interventions import moved_by
from grader.tests.checks.made import every, recording
from grader.tests.checks.shapes import teleported

STEADY = recording(every(0.5, 2.0, 1.0))


@pytest.mark.parametrize("name", ["teleport_absolute", "teleport_relative", "rotate_absolute", "reset"])
def test_a_call_that_changed_nothing_moved_nothing(name: str) -> None:
    assert moved_by(replace(STEADY, interventions=(name,)), from_start=True) is None


@pytest.mark.parametrize("name", ["kill", "set_parameters"])
def test_a_call_that_removes_the_turtle_or_its_rules_always_counts(name: str) -> None:
    assert moved_by(replace(STEADY, interventions=("set_pen", name)), from_start=False) == name


def test_a_jump_counts_unless_it_comes_before_the_first_command_where_that_is_allowed() -> None:
    assert moved_by(teleported(STEADY), from_start=False) == "teleport_absolute"
    early = teleported(STEADY, at_s=0.1)
    assert moved_by(early, from_start=False) is None
    assert moved_by(early, from_start=True) == "teleport_absolute"


def test_a_turn_that_no_command_asked_for_counts() -> None:
    frames = STEADY.frames
    late = frames.t_s > 5.0
    angular = np.where(late, -1.0, frames.angular)
    theta = np.cumsum(angular) * 0.016
    linear = np.where(late, 0.0, frames.linear)
    turned = replace(frames, angular=angular, theta=theta, linear=linear)
    assert moved_by(replace(STEADY, frames=turned, interventions=("rotate_absolute",)), from_start=False) is not None


def test_without_a_call_nothing_else_can_have_moved_it() -> None:
    assert moved_by(replace(teleported(STEADY), interventions=("spawn", "set_pen")), from_start=True) is None
