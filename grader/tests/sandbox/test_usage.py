"""The time for which the processes of a cell are ready to run does not depend on other load of the machine."""

from __future__ import annotations

import socket
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest

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
