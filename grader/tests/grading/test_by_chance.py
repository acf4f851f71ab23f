"""A trial in simulated time that stopped by chance is repeated at most twice.

If the last repeated trial also stops, a trial in wall time decides.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Status
from grader.colcon.runner import Built
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.tests.checks.made import BUILD, exercise, good, submission
from grader.tests.no_ros import without_ros
from grader.trial.trial import WallTimeNeeded

if TYPE_CHECKING:
    from pathlib import Path

    from grader.trial.recording import Recording
    from grader.trial.trial import Plan

CHANCE = WallTimeNeeded("its threads keep waking each other up", by_chance=True)
SLEEPS = WallTimeNeeded("the node sleeps in wall time")


@dataclass
class Trials:
    """A replacement for the class `Trial`.

    Each trial in simulated time raises the next error in `doubts`, until no error is left.
    """

    doubts: list[WallTimeNeeded]
    clocks: list[str] = field(default_factory=list)
    """The clock of each trial that was run."""

    def __call__(self, plan: Plan, *_: object, in_cell: bool) -> Any:  # noqa: ANN401 - a Trial
        assert not in_cell
        return _Trial(self, plan.clock)


@dataclass
class _Trial:
    trials: Trials
    clock: Any

    def __enter__(self) -> _Trial:  # noqa: PYI034 - typing.Self is Python 3.11's
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def await_ready(self) -> None:
        pass

    def run(self, *_: object) -> Recording:
        self.trials.clocks.append(self.clock)
        if self.clock == "simulated" and self.trials.doubts:
            raise self.trials.doubts.pop(0)
        return replace(good(), clock=self.clock)


@pytest.mark.parametrize(
    ("doubts", "clocks"),
    [
        ([], ["simulated"]),
        ([CHANCE], ["simulated", "simulated"]),
        ([CHANCE, CHANCE], ["simulated", "simulated", "simulated"]),
        ([CHANCE, CHANCE, CHANCE], ["simulated", "simulated", "simulated", "wall"]),
        ([CHANCE, SLEEPS], ["simulated", "simulated", "wall"]),
        ([SLEEPS], ["simulated", "wall"]),
    ],
)
def test_only_what_happened_by_chance_is_tried_again(
    doubts: list[WallTimeNeeded], clocks: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    without_ros(tmp_path, monkeypatch)
    trials = Trials(list(doubts))
    options = Options(in_cell=False)
    graded = grade(exercise(), submission(), options, build=lambda *_, **__: Built(BUILD, b""), trial=trials)
    assert trials.clocks == clocks
    assert {outcome.status for outcome in graded.report.outcomes} == {Status.PASSED}
