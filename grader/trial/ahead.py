"""The trials of one submission. The trials start during the build, and several trials can run in parallel.

The trials start one after the other, to leave most of a processor to the build. Simulated time does not depend on the
speed of the machine, so parallel trials do not affect each other. A trial in wall time needs the processors to itself,
so the caller first waits for the other trials (`settle`).
"""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import ExitStack
from threading import Lock
from typing import TYPE_CHECKING, Protocol

from grader.common.lazy import load_numpy

if TYPE_CHECKING:
    from grader.trial.recording import Recording
    from grader.trial.trial import Trial


class Runs(Protocol):
    """A trial whose node may or may not have been started yet."""

    def run(self, package: str, executable: str, tree: bytes) -> Recording:
        """Run the executable and return the recording, like `Trial.run`."""
        ...


class _UnderWay:
    """A trial whose node has already been started."""

    def __init__(self, recording: Future[Recording]) -> None:
        self._recording = recording

    def run(self, *_: object) -> Recording:
        return self._recording.result()


class _Started:
    """A trial that has been started or is about to be started."""

    def __init__(self, trial: Trial, ready: Future[None]) -> None:
        self._trial = trial
        self._ready = ready

    def run(self, package: str, executable: str, tree: bytes) -> Recording:
        self._ready.result()
        return self._trial.run(package, executable, tree)


class Ahead:
    """The trials of a submission, as a context manager. On exit, the manager stops every trial that it started.

    Each trial has a name. At most `at_once` of the trials that `run` was called for are running at the same time.
    """

    def __init__(self, at_once: int) -> None:
        self._at_once = at_once
        self._begin_empty()

    def _begin_empty(self) -> None:
        self._pool = ThreadPoolExecutor(self._at_once)
        self._starter = ThreadPoolExecutor(1)
        self._stack = ExitStack()
        self._entering = Lock()
        self._left = False
        self._started: dict[str, _Started] = {}
        self._under_way: dict[str, Future[Recording]] = {}

    def __enter__(self) -> Ahead:  # noqa: PYI034 - typing.Self is Python 3.11's
        self._pool.submit(load_numpy)  # reading a recording requires numpy, and there is time to import it now
        return self

    def __exit__(self, *_: object) -> None:
        self._stop()

    def clear(self) -> None:
        """Stop and remove every trial."""
        self._stop()
        self._begin_empty()

    def _stop(self) -> None:
        for pool in (self._starter, self._pool):
            pool.shutdown(wait=False, cancel_futures=True)
        with self._entering:
            self._left = True
        # Close the trials first, because the threads wait for them to finish.
        self._stack.close()
        for pool in (self._starter, self._pool):
            pool.shutdown()

    def start(self, name: str, trial: Trial) -> None:
        """Start the simulator and the launcher of this trial as soon as those of the previous trials are ready.

        If the start fails, the trial's `run` raises the error.
        """
        self._started[name] = _Started(trial, self._starter.submit(self._begin, trial))

    def _begin(self, trial: Trial) -> None:
        with self._entering:
            if self._left:
                return
            self._stack.enter_context(trial)
        trial.await_ready()

    def run(self, name: str, package: str, executable: str, tree: bytes) -> None:
        """Start the node of this trial.

        After this call, `trial(name).run` returns the recording.

        If the node has already been started, it continues to run.
        """
        if name not in self._under_way:
            self._under_way[name] = self._pool.submit(self._started[name].run, package, executable, tree)

    def trial(self, name: str) -> Runs | None:
        """Return the trial (its `run` returns the recording), or None if it was not started."""
        if name in self._under_way:
            return _UnderWay(self._under_way[name])
        return self._started.get(name)

    def settle(self) -> None:
        """Wait until no node is running."""
        wait(self._under_way.values())
