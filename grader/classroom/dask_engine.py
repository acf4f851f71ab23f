"""An engine that grades with Dask workers on one or many machines.

The machines need only this project, and receive submissions as bytes. Each thread of a Dask worker runs one of our
worker processes (worker.py), so a submission that kills that process does not kill the Dask worker. This module decides
which Dask worker gets which submission. Each thread gets one submission at a time, without a queue. Therefore, if a
machine is lost, a failed attempt is counted only for the submissions that were running on this machine.
"""

from __future__ import annotations

import pickle
import queue
import time
import uuid
from dataclasses import dataclass
from threading import Lock
from typing import TYPE_CHECKING, Any

from grader.classroom.engine import TASK_S, Died, Event, Finished
from grader.classroom.worker import Worker
from grader.errors import MachineError, UsageError

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType

    from grader.classroom.task import Done, Task

CONNECT_S = 10.0
WORKERS_S = 60.0
"""The maximum time to wait for the first worker, or for a new worker after all workers are gone (s)."""
LOOK_S = 1.0
"""The interval at which the list of workers is updated (s)."""

# The Dask worker's process keeps these workers after a task, so the next task does not have to start one.
_idle: list[Worker] = []
_lock = Lock()


def perform_here(packed: bytes) -> tuple[str, object]:
    """Grade a pickled task in a separate process. This function runs in a thread of a Dask worker.

    Return ("done", Done), ("fails", text) if this machine cannot grade, or ("died", text) if the process died or
    needed more than TASK_S.
    """
    task = pickle.loads(packed)
    with _lock:
        worker = _idle.pop() if _idle else Worker()
    worker.send(task)
    ends_s = time.monotonic() + TASK_S
    while True:
        if not worker.connection.poll(max(0.0, ends_s - time.monotonic())):
            worker.close()
            return "died", f"it was still busy after {TASK_S / 60:.0f} minutes"
        answer = worker.receive()
        if answer is None:
            why = worker.last_words()
            worker.close()
            return "died", why
        if answer[0] in ("done", "fails"):
            with _lock:
                _idle.append(worker)
            return answer


@dataclass
class _Running:
    future: Any
    task: Task
    where: str


class DaskEngine:
    """Grades submissions with Dask workers. Each thread of a worker grades one submission at a time."""

    def __init__(self, address: str, jobs: int | None, tell: Callable[[str], None] = lambda _: None) -> None:
        try:
            from distributed import Client
        except ImportError as error:
            message = "Dask is not installed. Run `make cluster` in the course's folder to install Dask."
            raise UsageError(message) from error
        try:
            # Dask has no type annotations.
            self._client: Any = Client(f"tcp://{address}", timeout=CONNECT_S, set_as_default=False)  # type: ignore[no-untyped-call]
        except (OSError, ValueError) as error:
            message = (
                f"No Dask scheduler responds at {address}: start one with `python -I -m dask scheduler`, "
                "or correct HOST:PORT."
            )
            raise UsageError(message) from error
        self._most = jobs
        self._running: dict[str, _Running] = {}
        self._ended: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._threads: dict[str, int] = {}
        self._looked = 0.0
        self._last_heard_from = time.monotonic()
        if not self._worker_threads():
            tell(f"Waiting up to {WORKERS_S:.0f} s for a worker of Dask: start one with `{_start(address)}`")

    def __enter__(self) -> DaskEngine:  # noqa: PYI034 - typing.Self is Python 3.11's
        self._look()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None, /
    ) -> None:
        try:
            self._client.cancel([each.future for each in self._running.values()], force=True)
        finally:
            self._client.close(timeout=5)

    def has_room(self) -> bool:
        """Return whether a task can be started.

        This is the case if a thread is idle and fewer than the maximum number of tasks are running.
        """
        return (self._most is None or len(self._running) < self._most) and self._free() is not None

    def start(self, task: Task) -> None:
        """Start a task."""
        where = self._free()
        assert where is not None
        key = f"grade-{uuid.uuid4().hex}"
        # The scheduler forwards bytes without unpickling them.
        packed = pickle.dumps(task)
        future = self._client.submit(
            perform_here, packed, key=key, workers=[where], allow_other_workers=False, pure=False, retries=0
        )
        self._running[key] = _Running(future, task, where)
        future.add_done_callback(lambda ended: self._ended.put(ended.key))

    def events(self, timeout_s: float) -> list[Event]:
        """Return the events since the last call, as described in Engine."""
        happened: list[Event] = []
        try:
            first = self._ended.get(timeout=timeout_s)
        except queue.Empty:
            first = None
        while first is not None:
            if first in self._running:
                happened.append(self._event(self._running.pop(first)))
            first = None if self._ended.empty() else self._ended.get()
        if time.monotonic() - self._looked > LOOK_S:
            happened += self._look()
        return happened

    def _worker_threads(self) -> dict[str, int]:
        """Return the number of threads of each worker, by the address of the worker.

        Raises:
            MachineError: the connection to the scheduler was lost.
        """
        try:
            return dict(self._client.nthreads())
        except Exception as error:
            message = (
                f"The connection to Dask's scheduler was lost ({error}). The results so far are kept. Run "
                f"the same command again to continue."
            )
            raise MachineError(message) from error

    def _event(self, ended: _Running) -> Event:
        try:
            kind, what = ended.future.result(timeout=CONNECT_S)
        except Exception as error:  # Dask raises various exceptions if a worker has died
            return Died(ended.task, f"{type(error).__name__}: {error}")
        if kind == "done":
            done: Done = what
            return Finished(ended.task, done)
        if kind == "fails":
            raise MachineError(str(what))
        return Died(ended.task, str(what))

    def _free(self) -> str | None:
        """Return the worker with the most free threads, or None if no thread is free."""
        busy = [each.where for each in self._running.values()]
        free = {where: threads - busy.count(where) for where, threads in self._threads.items()}
        best = max(free, key=lambda where: free[where], default=None)
        return best if best is not None and free[best] > 0 else None

    def _look(self) -> list[Event]:
        """Update the list of workers. Return an event for each task whose worker was lost."""
        self._looked = time.monotonic()
        self._threads = self._worker_threads()
        if self._threads:
            self._last_heard_from = time.monotonic()
        elif time.monotonic() - self._last_heard_from > WORKERS_S:
            message = f"Dask has had no worker for {WORKERS_S:.0f} s: start one with `{_start('HOST:PORT')}`."
            raise MachineError(message)
        lost = [key for key, each in self._running.items() if each.where not in self._threads]
        gone = [self._running.pop(key) for key in lost]
        for each in gone:
            each.future.cancel(force=True)
        return [Died(each.task, f"the worker {each.where} was lost") for each in gone]


def _start(address: str) -> str:
    return f"python -I -m dask worker {address}"
