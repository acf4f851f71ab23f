"""The trials of one submission. They start while the submission is built. Those in simulated time run side by side.

They start one after the other, so that the build keeps most of a processor: all of them wait for it.
Simulated time has no pace of its own, so other trials change nothing in it. A trial in wall time needs the processors
for itself, so the caller waits for the others first (`settle`).
"""

from __future__ import annotations

import importlib
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import ExitStack
from threading import Lock
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from grader.trial.recording import Recording
    from grader.trial.trial import Trial


class Runs(Protocol):
    """A trial that waits for its node, or already runs it."""

    def run(self, package: str, executable: str, tree: bytes) -> Recording:
        """As `Trial.run`."""
        ...


class _UnderWay:
    """A trial whose node already runs."""

    def __init__(self, recording: Future[Recording]) -> None:
        self._recording = recording

    def run(self, *_: object) -> Recording:
        return self._recording.result()


class _Started:
    """A trial that was started, or soon will be."""

    def __init__(self, trial: Trial, ready: Future[None]) -> None:
        self._trial = trial
        self._ready = ready

    def run(self, package: str, executable: str, tree: bytes) -> Recording:
        self._ready.result()
        return self._trial.run(package, executable, tree)


class Ahead:
    """A context manager. Leaving it ends every trial that was started in it.

    A trial is named by its id. `at_once` trials run side by side.
    """

    def __init__(self, at_once: int) -> None:
        self._pool = ThreadPoolExecutor(at_once)
        self._starter = ThreadPoolExecutor(1)
        self._stack = ExitStack()
        self._entering = Lock()
        self._left = False
        self._started: dict[str, _Started] = {}
        self._under_way: dict[str, Future[Recording]] = {}

    def __enter__(self) -> Ahead:  # noqa: PYI034 - typing.Self is Python 3.11's
        self._pool.submit(importlib.import_module, "numpy")  # needed to read a recording; there is time now
        return self

    def __exit__(self, *_: object) -> None:
        for pool in (self._starter, self._pool):
            pool.shutdown(wait=False, cancel_futures=True)
        with self._entering:
            self._left = True
        # The trials first: the threads wait for their ends.
        self._stack.close()
        for pool in (self._starter, self._pool):
            pool.shutdown()

    def start(self, name: str, trial: Trial) -> None:
        """Start simulator and launcher as soon as those of the trials before are ready.

        If that fails, the trial's `run` raises the error.
        """
        self._started[name] = _Started(trial, self._starter.submit(self._begin, trial))

    def _begin(self, trial: Trial) -> None:
        with self._entering:
            if self._left:
                return
            self._stack.enter_context(trial)
        trial.await_ready()

    def run(self, name: str, package: str, executable: str, tree: bytes) -> None:
        """Start the node of a trial that was started. `trial` returns it, with its recording."""
        self._under_way[name] = self._pool.submit(self._started[name].run, package, executable, tree)

    def trial(self, name: str) -> Runs | None:
        """Return the trial, for its recording; None if it was not started."""
        if name in self._under_way:
            return _UnderWay(self._under_way[name])
        return self._started.get(name)

    def settle(self) -> None:
        """Wait until no node runs."""
        wait(self._under_way.values())
