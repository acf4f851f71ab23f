"""Run scripts as nodes, and find the processes of a trial, for tests of the fork servers."""

from __future__ import annotations

import io
import os
import signal
import tarfile
from pathlib import Path
from threading import Timer
from typing import TYPE_CHECKING

from grader.ros.installation import find_ros
from grader.ros.underlay import with_turtlesim
from grader.tests.waiting import HANG_S
from grader.trial.recording import Pose
from grader.trial.trial import Plan, Trial

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.trial.fork_client import ForkServer
    from grader.trial.recording import Recording

WALL = Plan("wall", Pose(5.5, 5.5, 0.0), None, 0.1)
"""A trial in wall time."""


def run(
    script: str, plan: Plan = WALL, *, share: bool = False, meanwhile: Callable[[], object] = lambda: None
) -> Recording:
    """Run the script as the node of a trial in wall time. `share` is the argument of fork_client.conductors.

    `meanwhile` is called in another thread, one second after the trial is ready.
    """
    timer = Timer(1.0, meanwhile)
    tree = io.BytesIO()
    with tarfile.open(fileobj=tree, mode="w") as archive:
        member = tarfile.TarInfo("package/lib/package/node")
        member.mode, member.size = 0o755, len(script.encode())
        archive.addfile(member, io.BytesIO(script.encode()))
    with Trial(plan, with_turtlesim(find_ros()), in_cell=True, share=share) as trial:
        trial.await_ready()
        timer.start()
        try:
            return trial.run("package", "node", tree.getvalue())
        finally:
            timer.cancel()
            timer.join()


def mapped(pid: int) -> set[str]:
    """Return the places at which a process has mapped the C library."""
    return {line.split("-")[0] for line in Path(f"/proc/{pid}/maps").read_text().splitlines() if "libc.so" in line}


def forks(trial: Trial) -> tuple[int, int]:
    """Return the process ids of the conductor and of the node of a trial that is ready."""
    _, conductor, forks_nodes = trial._conductor.pids()
    return conductor, children(children(forks_nodes)[0])[0]


def children(pid: int) -> list[int]:
    """Return the child processes of a process with one thread."""
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def kill(server: ForkServer) -> None:
    """Kill the process of a fork server, and wait until it has ended."""
    assert server._process is not None
    os.kill(server._process.pid, signal.SIGKILL)
    server._process.wait(HANG_S)
