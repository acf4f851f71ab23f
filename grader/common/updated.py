"""Find out whether the course has changed since this process was started, for example through `git pull`.

Python imports some modules only when they are needed, and a grader starts other processes. After an update, a process
that was started before would run old and new code together, with errors or wrong verdicts as the result.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

import grader

START_AGAIN = (
    "The course was updated after this command had been started. Press Ctrl-C if the command is still running, and "
    "type it again."
)
_NOT_IMPORTED = ("__pycache__", "benchmarks", "tests")
_START = 19
"""The index of the start time (clock ticks since the machine was started) after the command in /proc/PID/stat."""


def updated() -> bool:
    """Return whether a module of the grader has changed since this process was started.

    The time at which the kernel last changed the file counts, since `git` and archives can set the other times. Times
    in the future do not count: the system clock was set back. If the machine refuses to say when this process was
    started, the result is False.
    """
    now = time.time()
    try:
        start = _start()
    except OSError:
        return False
    return any(start < _changed(path) <= now for path in _modules())


def _start() -> float:
    """Return the time at which this process was started."""
    ticks = int(Path("/proc/self/stat").read_text("utf-8", "replace").rpartition(")")[2].split()[_START])
    per_second = os.sysconf("SC_CLK_TCK")
    # A busy machine may interrupt a measurement, so the shortest counts. The kernel rounds the number of ticks down.
    return min(_measured_boot() for _ in range(3))[1] + (ticks + 1) / per_second


def _measured_boot() -> tuple[float, float]:
    """Return the duration of this measurement, and the time at which the machine was started."""
    before = time.clock_gettime(time.CLOCK_BOOTTIME)
    now = time.time()
    return time.clock_gettime(time.CLOCK_BOOTTIME) - before, now - before


def _modules() -> list[str]:
    found = []
    for folder, below, names in os.walk(Path(grader.__file__).parent):
        below[:] = [name for name in below if name not in _NOT_IMPORTED]
        found += [f"{folder}/{name}" for name in names if name.endswith(".py")]
    return found


def _changed(path: str) -> float:
    try:
        return os.stat(path).st_ctime  # noqa: PTH116 - much faster than Path.stat
    except OSError:
        return 0.0  # removed since the folder was listed
