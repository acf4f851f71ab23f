"""The time for which the processes of a cell are ready to run does not depend on other load of the machine."""

from __future__ import annotations

import itertools
import socket
import time
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest

from grader.sandbox import usage
from grader.sandbox.limits import MIB, Limits
from grader.sandbox.usage import Guard, exceeded
from grader.tests.trial.program import python
from grader.tests.waiting import until

if TYPE_CHECKING:
    import subprocess

WORK_S = 0.4
STARTS_TWO = f"""
import os, sys, time
os.sched_setaffinity(0, {{min(os.sched_getaffinity(0))}})
print("ready", flush=True)
for _ in range(2):
    if os.fork() == 0:
        while time.process_time() < {WORK_S}:
            pass
        os.write(1, b"worked\\n")
        sys.stdin.readline()
        os._exit(0)
sys.stdin.readline()
"""
"""A program that starts two processes on one processor, so that at any time one of them waits."""
STARTS_ONE = """
import os, signal
print("ready", flush=True)
os.read(0, 1)
if os.fork() == 0:
    os.read(0, 1)
    os._exit(0)
signal.pause()
"""
LIMITS = Limits(processes=50, cpu_s=60)


def lines(process: subprocess.Popen[str], count: int) -> None:
    assert process.stdout is not None
    for _ in range(count):
        assert process.stdout.readline() == "worked\n"


def test_processes_that_share_a_processor_are_ready_for_as_long_as_with_one_each() -> None:
    with python(STARTS_TWO) as process:
        guard = Guard([process.pid], LIMITS, lambda _: None)
        lines(process, 2)
        until(lambda: guard.ready_s(but=process.pid) >= 2.5 * WORK_S)
        until(lambda: guard.waited_s() >= 0.5 * WORK_S)
        guard.close()
    assert guard.ready_s(but=0) > guard.ready_s(but=process.pid)


def test_processes_that_exit_between_two_observations_count(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each process is observed at most once, just after its start."""
    pids = itertools.count(2)
    monkeypatch.setattr(usage, "family", lambda *_: [1, next(pids)])
    monkeypatch.setattr(usage, "cpu_s", lambda _: 0.0)
    monkeypatch.setattr(usage, "_ran_and_waited_s", lambda _: (0.0, 0.0))
    monkeypatch.setattr(usage, "_state", lambda _: "R")
    monkeypatch.setattr(usage, "exceeded", lambda *_, **__: None)
    begun_s = time.monotonic()
    guard = Guard([1], LIMITS, lambda _: None)
    until(lambda: guard.ready_s(but=1) >= 0.3)
    guard.close()
    assert guard.ready_s(but=1) <= time.monotonic() - begun_s


def test_a_process_that_was_started_is_noticed_until_it_has_exited() -> None:
    with python(STARTS_ONE) as process:
        assert process.stdin is not None
        guard = Guard([process.pid], LIMITS, lambda _: None)
        assert not guard.has_others()
        process.stdin.write("\n")
        process.stdin.flush()
        until(guard.has_others)
        process.stdin.write("\n")
        process.stdin.flush()
        until(lambda: not guard.has_others())  # the child is a zombie
        guard.close()


@pytest.mark.parametrize(("in_room", "over"), [(True, "memory"), (False, None)], ids=["in a room", "elsewhere"])
def test_data_in_the_network_of_a_room_counts(*, in_room: bool, over: str | None) -> None:
    """The simulator and a node are in one room: a node can fill the sockets of both."""
    with ExitStack() as stack:
        receivers = [stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) for _ in range(60)]
        sender = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        for receiver in receivers:
            receiver.bind(("127.0.0.1", 0))
            for _ in range(10):
                sender.sendto(bytes(20_000), receiver.getsockname())
        with python("import sys; print('ready', flush=True); sys.stdin.readline()") as process:
            assert exceeded([process.pid], Limits(total_memory=12 * MIB), in_room=in_room) == over
