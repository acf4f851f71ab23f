"""The choice of the clock: for the first run of a trial, and for its repetition."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.judge import judge_so_far
from grader.grading.clock import Attempt, after_doubt, after_simulated, first_clock, stops_at_doubt
from grader.tests.checks.made import NODE_FILE, every, evidence, good, node, recording, submission
from grader.trial.trial import WallTimeNeeded

if TYPE_CHECKING:
    import pytest

    from grader.trial.recording import Recording

TIMER = ("import rclpy", "import time\nimport rclpy\ntime.time()")


def attempt(made: Recording) -> Attempt:
    given = evidence(made)
    return Attempt(given, judge_so_far(given, {}))


def test_the_option_decides_whatever_the_source_contains() -> None:
    asleep = evidence(None, node(TIMER))
    assert first_clock("simulated", asleep).name == "simulated"
    assert first_clock("wall", evidence(None)).why == "chosen with --clock wall"


def test_a_node_without_signs_begins_in_simulated_time() -> None:
    assert first_clock("auto", evidence(None)).name == "simulated"


def test_a_sign_in_the_source_is_named_with_its_place() -> None:
    clock = first_clock("auto", evidence(None, node(TIMER)))
    assert clock.name == "wall"
    assert clock.why.startswith(f"time at {NODE_FILE}:")


def test_a_source_that_cannot_be_read_is_judged_in_wall_time(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise RecursionError

    monkeypatch.setattr("grader.grading.clock.wall_clues", broken)
    clock = first_clock("auto", evidence(None, submission()))
    assert (clock.name, "could not be read (RecursionError)" in clock.why) == ("wall", True)


def test_a_doubt_ends_a_trial_only_if_no_clock_was_requested() -> None:
    assert [stops_at_doubt(choice) for choice in ("auto", "simulated", "wall")] == [True, False, False]
    assert after_doubt(WallTimeNeeded("the node sleeps in wall time")).why == "the node sleeps in wall time"


def test_a_value_near_an_edge_is_decided_in_wall_time() -> None:
    near = attempt(recording(every(0.475, 2.0, 1.0)))
    decides = after_simulated("auto", near)
    assert decides is not None
    assert decides.name == "wall"
    assert after_simulated("simulated", near) is None
    assert after_simulated("auto", attempt(good())) is None
