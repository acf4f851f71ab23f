"""The trials of one submission: they are started beside the build, and those in simulated time run side by side.

One is started after the other, so that the build, which all of them wait for, keeps most of a processor.
Simulated time has no pace of its own, so company changes nothing that a trial sees. One under the wall's clock wants
the processors for itself: whoever runs it lets the others end first (`settle`).
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
    """A trial that waits for its node, or has it already."""

    def run(self, package: str, executable: str, tree: bytes) -> Recording:
        """As `Trial.run`."""
        ...


class _UnderWay:
    """A trial that was begun before somebody asked for it."""

    def __init__(self, recording: Future[Recording]) -> None:
        self._recording = recording

    def run(self, *_: object) -> Recording:
        return self._recording.result()


class _Started:
    """A trial that is started, or will be in a moment."""

    def __init__(self, trial: Trial, ready: Future[None]) -> None:
        self._trial = trial
        self._ready = ready

    def run(self, package: str, executable: str, tree: bytes) -> Recording:
        self._ready.result()
        return self._trial.run(package, executable, tree)


class Ahead:
    """A context manager; leaving it ends every trial that was started in it.

    Trials have names: "" is the exercise's own. `at_once` of them run side by side.
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
        self._pool.submit(importlib.import_module, "numpy")  # what reads a recording needs it, and now there is time
        return self

    def __exit__(self, *_: object) -> None:
        for pool in (self._starter, self._pool):
            pool.shutdown(wait=False, cancel_futures=True)
        with self._entering:
            self._left = True
        # The trials first: their ends are what the threads wait for.
        self._stack.close()
        for pool in (self._starter, self._pool):
            pool.shutdown()

    def start(self, name: str, trial: Trial) -> None:
        """Start simulator and launcher as soon as those before them are ready.

        What goes wrong is told by the trial's `run`.
        """
        self._started[name] = _Started(trial, self._starter.submit(self._begin, trial))

    def _begin(self, trial: Trial) -> None:
        with self._entering:
            if self._left:
                return
            self._stack.enter_context(trial)
        trial.await_ready()

    def run(self, name: str, package: str, executable: str, tree: bytes) -> None:
        """Begin to run the node of a trial that was started; what comes of it is told by `trial`."""
        self._under_way[name] = self._pool.submit(self._started[name].run, package, executable, tree)

    def trial(self, name: str) -> Runs | None:
        """The trial to ask for its recording; None when it was not started."""
        if name in self._under_way:
            return _UnderWay(self._under_way[name])
        return self._started.get(name)

    def settle(self) -> None:
        """Wait until no trial is under way."""
        wait(self._under_way.values())
