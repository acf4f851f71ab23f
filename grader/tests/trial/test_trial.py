from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

from grader.recording import Pose
from grader.ros import find_ros
from grader.trial.trial import Plan, Trial

if TYPE_CHECKING:
    from collections.abc import Callable

    import pytest


def test_the_end_of_a_trial_is_the_end_of_a_child_that_does_not_die_with_its_parent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # As bubblewrap's own child between its birth and its prctl(PR_SET_PDEATHSIG).
    said = tmp_path / "pid"
    starter = ["sh", "-c", f"sleep 300 & echo $! > {said}.new; mv {said}.new {said}; wait"]
    monkeypatch.setattr("grader.sandbox.room", lambda *_, **__: starter)
    trial = Trial(Plan("simulated", Pose(5.5, 5.5, 0.0), None, 1.0), find_ros(), None, in_cell=True)
    trial.start()
    _wait_until(said.exists)
    child = Path("/proc", said.read_text("ascii").strip())
    assert child.exists()
    trial.close()
    _wait_until(lambda: not _alive(child))


def _alive(process: Path) -> bool:
    try:
        return (process / "stat").read_bytes().rpartition(b")")[2].split()[0] not in (b"Z", b"X")
    except OSError:
        return False


def _wait_until(happened: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 30.0
    while not happened():
        assert time.monotonic() < deadline
        time.sleep(0.01)
