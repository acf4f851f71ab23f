"""A trial in wall time that fails on a crowded machine is repeated alone. On an idle machine, its result is final."""

from __future__ import annotations

import fcntl
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Status
from grader.colcon.runner import Built
from grader.grading import turns
from grader.grading.clock import WALL_TRIALS
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.tests.checks.made import BUILD, every, exercise, good, recording, submission
from grader.tests.no_ros import without_ros

if TYPE_CHECKING:
    from pathlib import Path

    from grader.grading.grade import Graded
    from grader.trial.recording import Recording

RIGHT = replace(good(), clock="wall")
WRONG = recording(every(0.25, 2.0, 1.0), clock="wall")


@dataclass
class Trials:
    """A replacement for the class `Trial`. Each trial returns the next recording."""

    recordings: list[Recording]
    alone: list[bool] = field(default_factory=list)
    """For each trial: whether this grader had the machine to itself, so that no other grader could run a trial."""

    def __call__(self, *_: object, in_cell: bool) -> Any:  # noqa: ANN401 - a Trial to whoever makes it
        assert not in_cell
        return self

    def __enter__(self) -> Trials:  # noqa: PYI034 - typing.Self is Python 3.11's
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def await_ready(self) -> None:
        pass

    def run(self, *_: object) -> Recording:
        self.alone.append(_is_taken(turns.folder() / "machine"))
        return self.recordings[len(self.alone) - 1]


def _is_taken(lock: Path) -> bool:
    """Return whether no other process can share the lock."""
    with lock.open("ab") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        return False


@pytest.fixture(autouse=True)
def nobody_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    without_ros(tmp_path, monkeypatch)


def graded(trials: Trials) -> Graded:
    options = Options(in_cell=False, clock="wall")
    return grade(exercise(), submission(), options, build=lambda *_, **__: Built(BUILD, b""), trial=trials)


def crowded(observed: Recording, *stalls: tuple[float, float]) -> Recording:
    return replace(observed, crowded=True, stalls=stalls)


def statuses(of: Graded) -> set[Status]:
    return {outcome.status for outcome in of.report.outcomes}


def stalls(of: Graded) -> tuple[tuple[float, float], ...]:
    """Return the stalls of the recording that counts."""
    assert of.evidence.run.recording is not None
    return of.evidence.run.recording.stalls


def test_a_trial_that_passes_is_made_once_however_crowded_the_machine_was() -> None:
    trials = Trials([crowded(RIGHT)])
    assert statuses(graded(trials)) == {Status.PASSED}
    assert trials.alone == [False]


def test_a_trial_that_fails_on_a_machine_of_its_own_is_made_once() -> None:
    trials = Trials([WRONG])
    assert Status.FAILED in statuses(graded(trials))
    assert trials.alone == [False]


@pytest.mark.parametrize(
    "first", [crowded(WRONG), replace(WRONG, stalls=((1.0, 1.1),))], ids=["a crowded machine", "a stall"]
)
def test_a_trial_that_fails_on_a_busy_machine_is_made_again_alone_and_the_one_that_passes_counts(
    first: Recording,
) -> None:
    trials = Trials([first, crowded(RIGHT, (2.0, 2.5))])
    found = graded(trials)
    assert statuses(found) == {Status.PASSED}
    assert stalls(found) == ((2.0, 2.5),)
    assert trials.alone == [False, True]


def test_the_first_trial_that_fails_undisturbed_counts() -> None:
    trials = Trials([crowded(WRONG), WRONG])
    found = graded(trials)
    assert Status.FAILED in statuses(found)
    assert found.evidence.run.recording is not None
    assert not found.evidence.run.recording.crowded
    assert trials.alone == [False, True]


def test_if_all_trials_fail_the_least_disturbed_one_counts() -> None:
    little, more = crowded(WRONG, (1.0, 1.1)), crowded(WRONG, (1.0, 1.3))
    trials = Trials([more, little, more])
    found = graded(trials)
    assert Status.FAILED in statuses(found)
    assert stalls(found) == little.stalls
    assert trials.alone == [False, True, True]
    assert len(trials.alone) == WALL_TRIALS


def test_a_stall_disturbs_less_than_a_crowd() -> None:
    stalled = replace(WRONG, stalls=((1.0, 1.3),))
    assert stalls(graded(Trials([crowded(WRONG), stalled, crowded(WRONG)]))) == stalled.stalls


def test_a_node_that_is_starved_in_every_trial_is_not_blamed() -> None:
    late = crowded(recording(every(0.5, 2.0, 1.0, first_s=6.0), clock="wall"), (0.0, 5.5))
    found = graded(Trials([late] * WALL_TRIALS))
    assert Status.ERROR in statuses(found)
    assert Status.FAILED not in statuses(found)
