"""A trial that does not end is killed. The node is blamed only if it could have used the processors."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from tempfile import TemporaryFile
from threading import Timer
from typing import TYPE_CHECKING

import pytest

from grader.errors import MachineError
from grader.ros.installation import find_ros
from grader.ros.underlay import with_turtlesim
from grader.sandbox import bubblewrap
from grader.tests.trial.made_conductor import READY, replace_conductor
from grader.tests.waiting import HANG_S
from grader.trial import time_limit
from grader.trial.conductor_process import PlainConductor
from grader.trial.recording import Pose
from grader.trial.time_limit import TimeLimit
from grader.trial.trial import OverwhelmedError, Plan, Trial

if TYPE_CHECKING:
    from collections.abc import Callable

PROCESSORS = len(os.sched_getaffinity(0))
HANGS = f"{READY}; exec sleep 300"


class Others:
    """A replacement for the measurement of the other programs: they use this share of all processors."""

    share = 0.0

    def worked_s(self, *, but_s: float) -> float:
        assert but_s >= 0.0
        return self.share * PROCESSORS * 1e3  # no test takes longer than 1000 s


def a_conductor(monkeypatch: pytest.MonkeyPatch, program: str) -> PlainConductor:
    """Start this program for sh as a conductor."""
    replace_conductor(monkeypatch, program)
    with TemporaryFile() as errors:
        return PlainConductor(find_ros(), Path("/tmp"), None, errors)


@pytest.mark.parametrize(("share", "starved"), [(0.0, False), (1.0, True)])
def test_a_trial_is_starved_if_other_programs_used_the_processors(
    monkeypatch: pytest.MonkeyPatch, share: float, *, starved: bool
) -> None:
    monkeypatch.setattr(time_limit, "Others", Others)
    monkeypatch.setattr(Others, "share", share)
    conductor = a_conductor(monkeypatch, "exec sleep 300")
    limit = TimeLimit(conductor)
    limit.start(0.1)
    assert conductor.wait(HANG_S) != 0
    conductor.close()
    assert limit.starved == starved


def test_a_trial_that_is_over_is_not_killed(monkeypatch: pytest.MonkeyPatch) -> None:
    conductor = a_conductor(monkeypatch, "exec cat")
    limit = TimeLimit(conductor)
    limit.start(HANG_S)
    limit.cancel()
    limit._timer.join(HANG_S / 2.0)
    assert not limit._timer.is_alive()
    conductor.stdin.close()
    assert conductor.wait(HANG_S) == 0
    conductor.close()


def test_a_closed_trial_gets_no_new_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """A trial that runs ahead can be closed while another thread is about to start the limit."""
    conductor = a_conductor(monkeypatch, "exec sleep 0.5")
    limit = TimeLimit(conductor)
    begun: list[float] = []

    def timer(seconds: float, end: Callable[[], None]) -> Timer:
        begun.append(seconds)
        return Timer(seconds, end)

    monkeypatch.setattr(time_limit, "Timer", timer)
    limit.close()
    limit.start(0.0)
    limit._end()
    assert begun == []
    assert conductor.wait(HANG_S) == 0
    conductor.close()


@pytest.mark.parametrize(
    ("out_of_memory", "why"), [(True, "too little memory was left"), (False, "Perhaps the memory .* killed it")]
)
@pytest.mark.parametrize("program", [f"{READY}; kill -9 $$", "read plan; kill -9 $$"], ids=["later", "at the start"])
def test_a_conductor_that_others_kill_is_the_machines_fault_and_was_not_too_slow(
    monkeypatch: pytest.MonkeyPatch, program: str, why: str, *, out_of_memory: bool
) -> None:
    monkeypatch.setattr(PlainConductor, "out_of_memory", lambda _: out_of_memory)
    replace_conductor(monkeypatch, program)
    with (
        Trial(Plan("wall", Pose(5.5, 5.5, 0.0), None, 1.0), find_ros(), in_cell=False) as trial,
        pytest.raises(MachineError, match=rf"was killed \(SIGKILL\) .*\. Its time limit was not the reason\. .*{why}"),
    ):
        trial.run("package", "executable", b"")


@pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
def test_in_a_room_the_node_is_not_among_those_who_can_kill_the_conductor() -> None:
    plan = Plan("wall", Pose(5.5, 5.5, 0.0), None, 1.0)
    with Trial(plan, with_turtlesim(find_ros()), in_cell=True) as trial:
        trial.await_ready()
        os.kill(trial._conductor.pids()[1], signal.SIGKILL)
        with pytest.raises(MachineError, match="or an administrator or another program killed it"):
            trial.run("package", "executable", b"")


@pytest.mark.parametrize(("share", "error"), [(0.0, OverwhelmedError), (1.0, MachineError)])
def test_a_trial_that_hangs_on_a_crowded_machine_is_the_machines_fault(
    monkeypatch: pytest.MonkeyPatch, share: float, error: type[Exception]
) -> None:
    monkeypatch.setattr(time_limit, "Others", Others)
    monkeypatch.setattr(Others, "share", share)
    replace_conductor(monkeypatch, HANGS)
    with Trial(Plan("wall", Pose(5.5, 5.5, 0.0), None, 1.0), find_ros(), in_cell=False) as trial:
        trial.await_ready()
        monkeypatch.setattr(time_limit, "Timer", lambda _, end: Timer(0.2, end))
        with pytest.raises(error):
            trial.run("package", "executable", b"")


def test_a_simulator_that_does_not_get_ready_on_a_crowded_machine_is_not_said_to_have_failed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(time_limit, "Others", Others)
    monkeypatch.setattr(Others, "share", 1.0)
    monkeypatch.setattr(time_limit, "Timer", lambda _, end: Timer(0.2, end))
    replace_conductor(monkeypatch, "echo 'a warning' >&2; exec sleep 300")
    with (
        Trial(Plan("wall", Pose(5.5, 5.5, 0.0), None, 1.0), find_ros(), in_cell=False) as trial,
        pytest.raises(MachineError, match="The machine was too busy to finish the trial in time"),
    ):
        trial.await_ready()
