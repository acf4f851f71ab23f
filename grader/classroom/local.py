"""An engine with worker processes on this machine.

The number of processes depends on the number of processors and the available memory.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from multiprocessing.connection import wait
from pathlib import Path
from typing import TYPE_CHECKING

from grader.classroom.engine import TASK_S, Died, Event, Finished, Progress
from grader.classroom.worker import Worker
from grader.errors import MachineError

if TYPE_CHECKING:
    from types import TracebackType

    from grader.classroom.task import Task

MEMORY_A_TASK = 1536 * 1024 * 1024
"""The memory that each task is expected to need (bytes). A cell may use more memory than this (sandbox.Limits), but few
cells do."""
JOBS_PER_PROCESSOR = 1.5
"""With one job per processor, the processors are idle for a quarter of the time, because a trial waits for the
discovery of its node (docs/costs.md)."""
WAITING_A_JOB = 2
"""For each job, this many additional tasks may run while other tasks are in a trial in wall time."""


def default_jobs() -> int:
    """Return the number of submissions to grade in parallel. It depends on the processors and the free memory."""
    return max(1, min(int(JOBS_PER_PROCESSOR * _processors()), _memory() // MEMORY_A_TASK))


def _processors() -> int:
    processors = len(os.sched_getaffinity(0))
    try:
        quota, period = Path("/sys/fs/cgroup/cpu.max").read_text().split()
        return max(1, min(processors, round(int(quota) / int(period))))
    except (OSError, ValueError):
        return processors  # no control group, or a control group without a limit


def _memory() -> int:
    free = 0
    for line in Path("/proc/meminfo").read_text().splitlines():
        if line.startswith("MemAvailable:"):
            free = int(line.split()[1]) * 1024
    try:
        group = Path("/sys/fs/cgroup")
        limit, used = (int((group / name).read_text()) for name in ("memory.max", "memory.current"))
        return min(free, limit - used)
    except (OSError, ValueError):
        return free


@dataclass
class _Busy:
    task: Task
    since: float
    waits: bool = False


class LocalEngine:
    """Keeps worker processes, gives each process one task at a time, and replaces processes that die."""

    def __init__(self, jobs: int) -> None:
        self._jobs = jobs
        self._most = max(jobs, min(jobs * (1 + WAITING_A_JOB), _memory() // MEMORY_A_TASK))
        self._idle: list[Worker] = []
        self._busy: dict[Worker, _Busy] = {}

    def __enter__(self) -> LocalEngine:  # noqa: PYI034 - typing.Self is Python 3.11's
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None, /
    ) -> None:
        for worker in (*self._idle, *self._busy):
            worker.close()

    def has_room(self) -> bool:
        """Return whether another task can be started now."""
        working = sum(not busy.waits for busy in self._busy.values())
        return working < self._jobs and len(self._busy) < self._most

    def start(self, task: Task) -> None:
        """Start a task."""
        worker = self._idle.pop() if self._idle else Worker()
        self._busy[worker] = _Busy(task, time.monotonic())
        worker.send(task)

    def events(self, timeout_s: float) -> list[Event]:
        """Return the events since the last call, as described in Engine."""
        happened: list[Event] = []
        by_connection = {worker.connection: worker for worker in self._busy}
        for ready in wait(list(by_connection), timeout_s):
            event = self._receive(by_connection[ready])  # type: ignore[index]
            if event is not None:
                happened.append(event)
        now = time.monotonic()
        hung = [worker for worker, busy in self._busy.items() if now - busy.since > TASK_S]
        return [
            *happened,
            *(self._lost(worker, f"it was still busy after {TASK_S / 60:.0f} minutes") for worker in hung),
        ]

    def _receive(self, worker: Worker) -> Event | None:
        busy = self._busy[worker]
        answer = worker.receive()
        if answer is None:
            return self._lost(worker, worker.last_words())
        kind, what = answer
        if kind == "done":
            self._idle.append(worker)
            del self._busy[worker]
            return Finished(busy.task, what)  # type: ignore[arg-type]
        if kind == "fails":
            raise MachineError(str(what))
        if kind == "now":
            busy.waits = what == "waits"
            return None
        return Progress(busy.task, str(what))

    def _lost(self, worker: Worker, why: str) -> Died:
        busy = self._busy.pop(worker)
        worker.close()
        return Died(busy.task, why)
