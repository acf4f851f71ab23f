from __future__ import annotations

import os
import sys
from importlib.util import cache_from_source
from pathlib import Path
from threading import Timer
from typing import TYPE_CHECKING

import grimp

from grader.ros.installation import find_ros
from grader.tests.waiting import until, until_gone
from grader.trial.recording import Pose
from grader.trial.trial import CONDUCTORS_ROOMS, Plan, Trial, compile_conductor

if TYPE_CHECKING:
    import pytest


def test_the_end_of_a_trial_is_the_end_of_a_child_that_does_not_die_with_its_parent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The state of bubblewrap's own child between its start and its prctl(PR_SET_PDEATHSIG).
    said = tmp_path / "pid"
    starter = ["sh", "-c", f"sleep 300 & echo $! > {said}.new; mv {said}.new {said}; wait"]
    monkeypatch.setattr("grader.sandbox.bubblewrap.room", lambda *_, **__: starter)
    trial = Trial(Plan("simulated", Pose(5.5, 5.5, 0.0), None, 1.0), find_ros(), in_cell=True)
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
    starter = ["sh", "-c", """read plan; echo '{"ready": true}'; read order"""]
    monkeypatch.setattr("grader.sandbox.bubblewrap.room", lambda *_, **__: starter)
    with Trial(Plan("simulated", Pose(5.5, 5.5, 0.0), None, 1.0), find_ros(), in_cell=True) as trial:
        trial.await_ready()
        assert [limit.finished.is_set() for limit in limits] == [True]


def test_a_suspended_trial_continues_when_it_is_used_and_is_not_suspended_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    starter = ["sh", "-c", """read plan; echo '{"ready": true}'; read order; read more"""]
    monkeypatch.setattr("grader.sandbox.bubblewrap.room", lambda *_, **__: starter)
    with Trial(Plan("simulated", Pose(5.5, 5.5, 0.0), None, 1.0), find_ros(), in_cell=True) as trial:
        stat = Path(f"/proc/{trial._processes.leader}/stat")
        trial.suspend()
        until(lambda: " T " in stat.read_text())
        trial.await_ready()
        trial.suspend()
        assert " T " not in stat.read_text()


def test_what_the_conductor_imports_is_compiled_when_it_starts(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    modules = [tmp_path / name for name in ("errors.py", *(f"{room}/a.py" for room in CONDUCTORS_ROOMS))]
    for module in modules:
        module.parent.mkdir(exist_ok=True)
        module.write_text("pass\n")
    monkeypatch.setattr("grader.trial.trial._FOLDER", tmp_path)
    monkeypatch.setattr("grader.sandbox.bubblewrap.room", lambda *_, **__: ["true"])
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    compile_conductor.cache_clear()
    try:
        with Trial(Plan("simulated", Pose(5.5, 5.5, 0.0), None, 1.0), find_ros(), in_cell=True):
            assert all(Path(cache_from_source(str(module))).is_file() for module in modules)
    finally:
        compile_conductor.cache_clear()


def test_the_rooms_that_are_compiled_are_those_that_the_conductor_imports_from() -> None:
    graph = grimp.build_graph("grader", cache_dir=None, exclude_type_checking_imports=True)
    modules = graph.find_upstream_modules("grader.trial.conductor")
    assert {module.split(".")[1] for module in modules if module.count(".") > 1} == set(CONDUCTORS_ROOMS)
