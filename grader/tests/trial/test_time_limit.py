"""A trial that does not end is killed. The node is blamed only if it could have used the processors."""

from __future__ import annotations

import os
import subprocess
from threading import Timer

import pytest

from grader.errors import MachineError
from grader.ros.installation import find_ros
from grader.trial import time_limit
from grader.trial.process_group import ProcessGroup
from grader.trial.recording import Pose
from grader.trial.time_limit import TimeLimit
from grader.trial.trial import OverwhelmedError, Plan, Trial

PROCESSORS = len(os.sched_getaffinity(0))
HANGS = ["sh", "-c", """read plan; echo '{"ready": true}'; read order; exec sleep 300"""]


class Others:
    """A replacement for the measurement of the other programs: they use this share of all processors."""

    share = 0.0

    def worked_s(self, *, but_s: float) -> float:
        assert but_s >= 0.0
        return self.share * PROCESSORS * 1e3  # no test takes longer than 1000 s


@pytest.mark.parametrize(("share", "starved"), [(0.0, False), (1.0, True)])
def test_a_trial_is_starved_if_other_programs_used_the_processors(
    monkeypatch: pytest.MonkeyPatch, share: float, *, starved: bool
) -> None:
    monkeypatch.setattr(time_limit, "Others", Others)
    monkeypatch.setattr(Others, "share", share)
    with subprocess.Popen(["sleep", "300"], start_new_session=True) as process:
        limit = TimeLimit(ProcessGroup(process.pid))
        limit.start(0.1)
        assert process.wait() != 0
    assert limit.starved == starved


def test_a_trial_that_is_over_is_not_killed() -> None:
    with subprocess.Popen(["sleep", "0.5"], start_new_session=True) as process:
        limit = TimeLimit(ProcessGroup(process.pid))
        limit.start(0.1)
        limit.cancel()
        assert process.wait() == 0


@pytest.mark.parametrize(("share", "error"), [(0.0, OverwhelmedError), (1.0, MachineError)])
def test_a_trial_that_hangs_on_a_crowded_machine_is_the_machines_fault(
    monkeypatch: pytest.MonkeyPatch, share: float, error: type[Exception]
) -> None:
    monkeypatch.setattr(time_limit, "Others", Others)
    monkeypatch.setattr(Others, "share", share)
    monkeypatch.setattr("grader.sandbox.bubblewrap.room", lambda *_, **__: HANGS)
    with Trial(Plan("wall", Pose(5.5, 5.5, 0.0), None, 1.0), find_ros(), in_cell=True) as trial:
        trial.await_ready()
        monkeypatch.setattr(time_limit, "Timer", lambda _, end: Timer(0.2, end))
        with pytest.raises(error):
            trial.run("package", "executable", b"")
