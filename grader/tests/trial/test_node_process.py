from __future__ import annotations

import errno
import fcntl
import os
import sys
import time
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING

import pytest

from grader.sandbox.limits import Limits
from grader.sandbox.usage import Guard
from grader.tests.waiting import HANG_S, until
from grader.trial import node_group, node_process
from grader.trial.launchers import LauncherProcess, LaunchError
from grader.trial.node_group import NodeGroup
from grader.trial.node_process import FULL, PIPE, NodeProcess, Stream, enlarge

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

PAGE = os.sysconf("SC_PAGE_SIZE")
SLOW = r"""printf '\0ready 0\n'; read order; trap 'sleep 1; exit 0' INT; echo waits; while :; do sleep 0.05; done"""
"""A node that takes a second to stop."""
QUICK = SLOW.replace("sleep 1; ", "")
STUCK = SLOW.replace("sleep 1; exit 0", "while :; do sleep 0.05; done")
"""A node that does not stop on Ctrl-C."""
ONLY_MAIN_EXITS = r"""
import ctypes, threading, time
print("\0ready 0", flush=True)
threading.Thread(target=time.sleep, args=(600,)).start()
ctypes.CDLL(None).pthread_exit(None)
"""


@pytest.fixture
def pipe() -> Iterator[tuple[int, int]]:
    reads, writes = os.pipe2(os.O_NONBLOCK)
    yield reads, writes
    os.close(reads)
    os.close(writes)


@pytest.mark.parametrize("capacity", [PAGE, 16 * PAGE, PIPE])
@pytest.mark.parametrize("size", [1, 100, 2049, 4095, 4097, 100_000])
def test_a_pipe_that_blocks_its_writer_counts_as_full(pipe: tuple[int, int], size: int, capacity: int) -> None:
    reads, writes = pipe
    fcntl.fcntl(writes, fcntl.F_SETPIPE_SZ, capacity)
    with suppress(BlockingIOError):
        while True:
            os.write(writes, b"x" * size)
    assert Stream(reads).read(0.0) >= FULL * capacity
    assert Stream(reads).read(0.0) == 0


def test_a_pipe_is_made_large(pipe: tuple[int, int]) -> None:
    assert enlarge(pipe[0]) == PIPE == fcntl.fcntl(pipe[1], fcntl.F_GETPIPE_SZ)


@pytest.mark.parametrize(("most", "size"), [(0, PAGE), (PIPE // 2, PIPE // 2), (PIPE // 4 + 1, PIPE // 4)])
def test_a_pipe_that_may_not_grow_is_used_as_it_is(
    monkeypatch: pytest.MonkeyPatch, pipe: tuple[int, int], most: int, size: int
) -> None:
    """The kernel refuses when all pipes of a user together exceed fs.pipe-user-pages-soft."""
    fcntl.fcntl(pipe[0], fcntl.F_SETPIPE_SZ, PAGE)
    real = fcntl.fcntl

    def refuses(fd: int, command: int, value: int = 0) -> int:
        if command == fcntl.F_SETPIPE_SZ and value > most:
            raise PermissionError
        return real(fd, command, value)

    monkeypatch.setattr(fcntl, "fcntl", refuses)
    assert enlarge(pipe[0]) == size == real(pipe[1], fcntl.F_GETPIPE_SZ)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Return a clock (s) for the time to exit. The clock advances only if the test sets it.

    While the clock stands still, a node is stopped by SIGINT alone, however slow the machine is.
    """
    now_s = [0.0]
    monkeypatch.setattr(node_process, "time", SimpleNamespace(monotonic=lambda: now_s[0]))
    monkeypatch.setattr(Guard, "waited_s", lambda *_, **__: 0.0)
    return now_s


@pytest.mark.parametrize(
    ("node", "waited_s", "by"), [(STUCK, 0.0, "SIGTERM"), (SLOW, HANG_S, "SIGINT")], ids=["idle", "crowded"]
)
def test_waiting_for_a_processor_after_ctrl_c_does_not_count(
    monkeypatch: pytest.MonkeyPatch, clock: list[float], node: str, waited_s: float, by: str
) -> None:
    waits = iter([0.0])
    monkeypatch.setattr(Guard, "waited_s", lambda *_, **__: next(waits, waited_s))
    with NodeProcess(LauncherProcess(["sh", "-c", node]), Limits(processes=50, cpu_s=60)) as process:
        process.await_ready()
        process.start({}, b"")
        until(lambda: process.read_output(0.0) > 0)
        process.interrupt()
        for _ in range(35):
            clock[0] += 0.1  # to a time between SIGTERM and SIGKILL
            process.escalate()
        until(process.ended)
        end = process.end(0.0)
    assert end.by == by
    assert end.stop_s == pytest.approx(3.5 if by == "SIGTERM" else 0.0)


def test_a_quick_node_is_not_blamed_for_a_slow_node_in_the_same_trial(tmp_path: Path, clock: list[float]) -> None:
    may_exit = tmp_path / "may exit"
    slow_one = SLOW.replace("sleep 1;", f'until [ -e "{may_exit}" ]; do sleep 0.01; done;')
    limits = Limits(processes=50, cpu_s=60)
    with (
        NodeProcess(LauncherProcess(["sh", "-c", QUICK]), limits) as quick,
        NodeProcess(LauncherProcess(["sh", "-c", slow_one]), limits) as slow,
    ):
        group = NodeGroup([slow, quick])
        _run(group)
        for _ in range(10):
            group.stop()
            clock[0] += 0.1
        may_exit.touch()
        _stop_until(group.all_ended, group)
        assert [quick.end(0.0).stop_s, slow.end(0.0).stop_s] == [0.0, pytest.approx(1.0)]


def test_a_node_is_not_blamed_for_a_pause_of_the_grader(tmp_path: Path, clock: list[float]) -> None:
    may_exit = tmp_path / "may exit"
    slow = SLOW.replace("sleep 1;", f'until [ -e "{may_exit}" ]; do sleep 0.01; done;')
    with NodeProcess(LauncherProcess(["sh", "-c", slow]), Limits(processes=50, cpu_s=60)) as process:
        group = NodeGroup([process])
        _run(group)
        group.stop()
        for _ in range(2):
            clock[0] += 2.0 * node_process.STOP_S
            group.stop()
        may_exit.touch()
        _stop_until(process.ended, group)
        end = process.end(0.0)
    assert (end.by, end.stop_s) == ("SIGINT", 2.0 * node_process.MOST_GAP_S)


@pytest.mark.usefixtures("clock")
def test_a_node_that_exits_while_another_one_is_being_stopped_has_not_ended_on_its_own(tmp_path: Path) -> None:
    stopping, pid = tmp_path / "stopping", tmp_path / "pid"
    slow_one = SLOW.replace("sleep 1;", f"touch {stopping}; while kill -0 $(cat {pid}); do sleep 0.01; done;")
    wait = f"echo $$ > {pid}; echo waits; until [ -e {stopping} ]; do sleep 0.01; done"
    follower = rf"printf '\0ready 0\n'; read order; {wait}; exit 3"
    limits = Limits(processes=50, cpu_s=60)
    with (
        NodeProcess(LauncherProcess(["sh", "-c", slow_one]), limits) as slow,
        NodeProcess(LauncherProcess(["sh", "-c", follower]), limits) as follows,
    ):
        _run_and_stop(NodeGroup([slow, follows]))
        end = follows.end(0.0)
    assert (end.by, end.exit_code, end.stop_s) == ("SIGINT", 3, 0.0)


@pytest.mark.usefixtures("clock")
def test_a_node_that_is_busy_after_another_one_has_left_gets_time_before_it_is_stopped() -> None:
    busy = r"printf '\0ready 0\n'; read order; trap 'exit 0' INT; echo waits; while :; do :; done"
    limits = Limits(processes=50, cpu_s=60)
    with (
        NodeProcess(LauncherProcess(["sh", "-c", QUICK]), limits) as first,
        NodeProcess(LauncherProcess(["sh", "-c", busy]), limits) as second,
    ):
        group = NodeGroup([first, second])
        _run(group)
        left_s = time.monotonic()
        while not first.ended():
            left_s = time.monotonic()  # `stop` may notice that the first node has left
            group.stop()
            time.sleep(0.01)
        _stop_until(second.ended, group)
        assert time.monotonic() - left_s >= node_group.SETTLES_S
        assert second.end(0.0).by == "SIGINT"


@pytest.mark.usefixtures("clock")
def test_a_node_with_too_many_threads_to_observe_is_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuses(_: int) -> None:
        raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    monkeypatch.setattr(node_group, "Threads", refuses)
    limits = Limits(processes=50, cpu_s=60)
    with (
        NodeProcess(LauncherProcess(["sh", "-c", QUICK]), limits) as first,
        NodeProcess(LauncherProcess(["sh", "-c", QUICK]), limits) as second,
    ):
        _run_and_stop(NodeGroup([first, second]))
        assert [each.end(0.0).by for each in (first, second)] == ["SIGINT", "SIGINT"]


def _run_and_stop(group: NodeGroup) -> None:
    """Start the nodes, wait until each of them has written something, and stop them."""
    _run(group)
    _stop_until(group.all_ended, group)


def _stop_until(ended: Callable[[], bool], group: NodeGroup) -> None:
    while not ended():
        group.stop()
        time.sleep(0.01)


def _run(group: NodeGroup) -> None:
    """Start the nodes, and wait until each of them has written something."""
    group.await_ready()
    group.start([{} for _ in group.processes], b"")
    for process in group.processes:
        until(partial(_has_written, process))


def _has_written(process: NodeProcess) -> bool:
    return process.read_output(0.0) > 0


def test_nobody_waits_for_the_exit_code_of_a_node_whose_main_thread_alone_has_exited(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with NodeProcess(LauncherProcess([sys.executable, "-c", ONLY_MAIN_EXITS]), Limits()) as process:
        process.await_ready()
        process.start({}, b"")
        until(lambda: Path(f"/proc/{process.pid}/stat").read_text().split()[2] == "Z")
        monkeypatch.setattr(LauncherProcess, "wait", lambda *_: pytest.fail("waited for the exit code"))
        process.scenario_is_over()
        assert not process.ended()
        assert not process.ended_itself


def test_the_error_of_a_launcher_that_exits_silently_is_not_empty() -> None:
    with (
        NodeProcess(LauncherProcess(["true"]), Limits(processes=50, cpu_s=60)) as process,
        pytest.raises(LaunchError, match="the launcher printed nothing"),
    ):
        process.await_ready()
