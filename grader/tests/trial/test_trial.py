from __future__ import annotations

import os
from pathlib import Path
from threading import Timer

import pytest

from grader.ros.installation import find_ros
from grader.ros.underlay import with_turtlesim
from grader.sandbox import bubblewrap
from grader.tests.trial.made_conductor import READY, replace_conductor
from grader.tests.waiting import until, until_gone
from grader.trial.recording import Pose
from grader.trial.trial import Plan, Trial


@pytest.mark.parametrize("start", ["sleep 300", "setsid sleep 300"], ids=["in its session", "in another session"])
def test_the_end_of_a_trial_is_the_end_of_a_child_that_does_not_die_with_its_parent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, start: str
) -> None:
    said = tmp_path / "pid"
    replace_conductor(monkeypatch, f"{start} & echo $! > {said}.new; mv {said}.new {said}; wait")
    trial = Trial(Plan("simulated", Pose(5.5, 5.5, 0.0), None, 1.0), find_ros(), in_cell=False)
    trial.start()
    until(said.exists)
    child = int(said.read_text("ascii"))
    os.kill(child, 0)
    trial.close()
    until_gone(child)


def test_a_trial_that_is_ready_may_wait_for_its_turn_as_long_as_it_takes(monkeypatch: pytest.MonkeyPatch) -> None:
    limits: list[Timer] = []

    class Limit(Timer):
        def start(self) -> None:
            limits.append(self)
            super().start()

    monkeypatch.setattr("grader.trial.time_limit.Timer", Limit)
    replace_conductor(monkeypatch, READY)
    with Trial(Plan("simulated", Pose(5.5, 5.5, 0.0), None, 1.0), find_ros(), in_cell=False) as trial:
        trial.await_ready()
        assert [limit.finished.is_set() for limit in limits] == [True]


@pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
def test_a_suspended_trial_continues_when_it_is_used_and_is_not_suspended_again() -> None:
    with Trial(Plan("simulated", Pose(5.5, 5.5, 0.0), None, 1.0), with_turtlesim(find_ros()), in_cell=True) as trial:
        _, conductor, _ = trial._conductor.pids()
        stat = Path(f"/proc/{conductor}/stat")
        trial.suspend()
        until(lambda: " T " in stat.read_text())
        trial.await_ready()
        trial.suspend()
        assert " T " not in stat.read_text()
