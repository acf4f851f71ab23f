from __future__ import annotations

import errno
import stat
import subprocess
import sys
from contextlib import ExitStack, closing
from pathlib import Path

import pytest

from grader.classroom import build_turns, task, worker
from grader.classroom.build_turns import build_in_turn, turn, turns
from grader.classroom.worker import Worker
from grader.tests.classroom.test_worker import below, refuses
from grader.tests.waiting import HANG_S
from grader.trial.fork_client import ForkServer

FORKS = """
import os
from grader.classroom import build_turns

os.sched_getaffinity = lambda _: {0, 1}

def in_a_fork(does):
    child = os.fork()
    if child == 0:
        does()
        os._exit(0)
    os.waitpid(child, 0)

def look():
    print("taken" if build_turns.take() is None else "free", flush=True)

def wait():
    with build_turns.turn(0.05):
        print("builds anyway", flush=True)

build_turns.lock_file()
with build_turns.turn():
    in_a_fork(look)
    in_a_fork(wait)
in_a_fork(look)  # this fork ends with its turn
in_a_fork(look)
build_turns.runner.build = lambda: in_a_fork(look)
build_turns.build_in_turn()
"""


@pytest.mark.parametrize(("processors", "at_once"), [(1, 1), (2, 1), (3, 1), (8, 4)])
def test_at_most_half_of_the_processors_build(processors: int, at_once: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("os.sched_getaffinity", lambda _: set(range(processors)))
    assert turns() == at_once


def test_a_turn_ends_with_its_build_or_its_process_and_nobody_waits_for_ever() -> None:
    program = [sys.executable, "-c", FORKS]
    said = subprocess.run(program, stdout=subprocess.PIPE, text=True, timeout=HANG_S, check=True).stdout
    assert said.splitlines() == ["taken", "builds anyway", "free", "free", "taken"]
    assert task._builds()._build is build_in_turn


@pytest.mark.parametrize(
    "refused", [OSError(errno.ENOLCK, "No locks available"), OSError(errno.EPERM, "Not permitted")]
)
def test_without_locks_nobody_waits(refused: OSError, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse() -> int:
        raise refused

    monkeypatch.setattr(build_turns, "lock_file", refuse)
    monkeypatch.setattr("time.sleep", lambda _: pytest.fail("waited"))
    with turn():
        pass


def test_all_workers_of_a_command_share_the_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    with closing(ForkServer(worker._started)) as server, ExitStack() as stack:
        monkeypatch.setattr(worker, "_server", lambda: server)
        assert all(map(refuses, [stack.enter_context(closing(Worker())) for _ in range(2)]))
        assert server._process is not None
        workers = [server._process.pid, *(pid for pid, line in below(server._process.pid).items() if "worker" in line)]
        of_server, *of_workers = map(_without_name, workers)
        assert len(of_server) == 1
        assert len(of_workers) >= 2
        assert all(of_server <= each for each in of_workers)


def _without_name(pid: int) -> set[int]:
    """Return the inodes of the regular files without a name that a process has open."""
    opened = [each.stat() for each in Path(f"/proc/{pid}/fd").iterdir()]
    return {each.st_ino for each in opened if stat.S_ISREG(each.st_mode) and each.st_nlink == 0}
