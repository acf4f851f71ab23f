"""Watch a folder, and grade the submission in it after every save.

While the learner is editing, the simulator and the launcher of the next trial are already waiting, and the result of
the last build is kept. Therefore, the verdict after a save takes little longer than the trial itself.
"""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass
from queue import SimpleQueue
from threading import Event, Thread, Timer
from typing import TYPE_CHECKING, Literal

from watchfiles import DefaultFilter, watch

from grader.colcon.rebuild import Rebuild
from grader.errors import MachineError, UsageError
from grader.grading.grade import Graded, can_be_explained, explained, grade
from grader.learner.current import require_current
from grader.submission.package import open_answers, open_submission
from grader.trial.trial import Plan, Trial

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from grader.checks.outcome import Outcome
    from grader.exercise.model import Exercise
    from grader.grading.options import Options
    from grader.ros.installation import Ros
    from grader.submission.package import Submission

DEBOUNCE_MS = 50
"""Events within this time (ms) count as one, because an editor that saves by renaming causes several events."""

_STEP_MS = 25
"""The polling interval for new events (ms). With an interval of 10 ms, an idle watch would use 0.7 % of a core."""
SUSPEND_S = 20.0
"""After this time (s) without a save, the waiting simulator is suspended."""
MOST_FOLDERS = 1000
"""The maximum number of folders of a package that are watched."""
_LOOK_MS = 500
"""The interval (ms) at which the watcher tests whether the path still leads to the watched folder."""


@dataclass(frozen=True)
class Happened:
    """An event for the main loop: a save (even without changes), a key press, or the end of the input."""

    kind: Literal["saved", "key", "end"]
    key: str = ""


class _Sources(DefaultFilter):
    """Accepts files that can affect a verdict, but not files that colcon and Python write."""

    ignore_dirs = (*DefaultFilter.ignore_dirs, "build", "install", "log")


def folders(top: Path) -> list[str]:
    """Return the folder and its subfolders that can contain sources: at most MOST_FOLDERS, and no symbolic links.

    A link to `/` in a package would otherwise use up the user's inotify watches.
    """
    found = []
    for folder, below, _ in os.walk(top):
        if not os.access(folder, os.R_OK | os.X_OK):
            continue
        found.append(folder)
        if len(found) == MOST_FOLDERS:
            break
        below[:] = sorted(name for name in below if name not in _Sources.ignore_dirs)
    return found


def _identity(folder: Path) -> tuple[int, int] | None:
    """Return the device and the inode of the folder at this path, or None if there is no such folder."""
    try:
        status = folder.stat()
    except OSError:
        return None
    return status.st_dev, status.st_ino


class Events:
    """The events for the main loop: key presses and saves in the watched folder, in the order in which they happen."""

    def __init__(self, read_key: Callable[[], str] | None) -> None:
        self._queue: SimpleQueue[Happened] = SimpleQueue()
        self._stop = Event()
        self._saved = Event()
        self.watched: list[str] = []
        """The paths that `folders` returned last, for the folder that is watched now."""
        # All folders share one reader of key presses, because a second reader would take keys from the first reader.
        if read_key is not None:
            Thread(target=self._keys, args=(read_key,), daemon=True).start()

    def watch(self, folder: Path) -> None:
        """Watch only this folder from now on.

        Once the watcher can notice saves, the event of a save is queued even if no file has changed, because the
        learner may have saved a file before.
        """
        self._stop.set()
        self._stop = Event()
        Thread(target=self._watch, args=(folder, self._stop), daemon=True).start()

    def __iter__(self) -> Iterator[Happened]:
        """Yield each event as it happens, until the end of the input. Several pending saves are yielded as one."""
        while (happened := self._queue.get()).kind != "end":
            if happened.kind == "saved":
                self._saved.clear()
            yield happened

    def waiting(self) -> bool:
        """Return whether there is an event that has not been yielded yet."""
        return not self._queue.empty()

    def press(self, key: str) -> None:
        """Add a key press, as if it came from the keyboard. Any thread may call this method."""
        self._queue.put(Happened("key", key))

    def close(self) -> None:
        """Stop watching, and end the iteration over the events."""
        self._stop.set()
        self._queue.put(Happened("end"))

    def _watch(self, folder: Path, stop: Event) -> None:
        """Watch the folder at this path. If the folder is replaced, watch the new folder at this path."""
        existed = False
        while not stop.is_set():
            watched = _identity(folder)
            if existed and watched is None:
                self._save(stop)
            existed = watched is not None
            if watched is None or not self._watch_one(folder, watched, stop):
                stop.wait(_LOOK_MS / 1000)

    def _watch_one(self, folder: Path, watched: tuple[int, int], stop: Event) -> bool:
        """Watch the folder until the path leads to another folder, or folders are added or removed.

        Return False if the folder could not be watched, or if `stop` is set.
        """
        begins = True
        self.watched = folders(folder)
        if not self.watched:
            return False
        try:
            for changes in watch(
                *self.watched,
                recursive=False,
                watch_filter=_Sources(),
                debounce=DEBOUNCE_MS,
                step=_STEP_MS,
                rust_timeout=_LOOK_MS,
                yield_on_timeout=True,
                stop_event=stop,
                raise_interrupt=False,
            ):
                if changes or begins:
                    self._save(stop)
                if _identity(folder) != watched or ((changes or begins) and folders(folder) != self.watched):
                    return True
                begins = False
        except FileNotFoundError:
            pass
        return False

    def _save(self, stop: Event) -> None:
        if not stop.is_set() and not self._saved.is_set():
            self._saved.set()
            self._queue.put(Happened("saved"))

    def _keys(self, read_key: Callable[[], str]) -> None:
        while key := read_key():
            self._queue.put(Happened("key", key))
        self._queue.put(Happened("end"))


class Watched:
    """One exercise in one folder that is graded repeatedly. Call `close` at the end."""

    def __init__(self, exercise: Exercise, folder: Path, options: Options) -> None:
        self.exercise = exercise
        self.folder = folder
        self.rebuild = Rebuild()
        self._options = options
        self._warm: tuple[Plan, Trial] | None = None
        self._wanted: tuple[Plan, Ros] | None = None
        self._unproved: Graded | None = None
        self._judged = ""
        """The digest of the last submission, or the reason why the submission could not be read."""

    def changed(self) -> bool:
        """Return whether the folder has changed since the last verdict."""
        try:
            return self._open().digest != self._judged
        except UsageError as error:
            return str(error) != self._judged
        except MachineError:
            return True  # the next grading reports the reason

    def grade(
        self,
        tell: Callable[[str], None] = lambda _: None,
        early: Callable[[Sequence[Outcome]], object] = lambda _: None,
        opened: Callable[[Submission], object] = lambda _: None,
    ) -> Graded:
        """Grade the current content of the folder. See `grader.grading.grade.grade` for `tell` and `early`.

        `opened` is called with the submission before it is graded. The caller shows the verdict, and then calls
        `prepare`.

        Raises:
            UsageError: the folder does not contain one package, or its files cannot be read.
            MachineError: the submission cannot be judged, because of the machine, or because the course was updated.
        """
        try:
            submission = self._open()
        except UsageError as error:
            self._judged = str(error)
            raise
        self._judged = submission.digest
        require_current(self.exercise)
        opened(submission)
        self._wanted = self._unproved = None
        graded = grade(
            self.exercise,
            submission,
            self._options,
            tell,
            early=early,
            build=self.rebuild,
            trial=self._next_trial,
        )
        require_current(self.exercise)
        self._unproved = graded
        return graded

    def prepare(self) -> None:
        """Start the simulator and the launcher of the next trial, if the last grading ran a trial in simulated time.

        Starting the simulator and the launcher keeps two processors busy for half a second.
        """
        if self._warm is None and self._wanted is not None:
            plan, ros = self._wanted
            trial = Trial(plan, ros, in_cell=self._options.in_cell)
            # If the trial cannot be started, the next grading reports the reason.
            with suppress(MachineError):
                trial.start()
                self._warm = (plan, trial)
                suspending = Timer(SUSPEND_S, trial.suspend)
                suspending.daemon = True
                suspending.start()

    @property
    def unproved(self) -> bool:
        """Whether the last report has causes that `prove` has not tested yet."""
        return self._unproved is not None and can_be_explained(self._unproved)

    def prove(self, tell: Callable[[str], None], give_up: Callable[[], bool]) -> Graded | None:
        """Prove the causes of the last report by testing fixes in a copy (see `grader.grading.explain`).

        Before each test, `give_up` is called to find out whether other work must be done first. If so, the tests stop,
        and the next call to `prove` starts from the beginning. Return the report with the results of the tests, or None
        if the tests were stopped, if no fix was tested, or if the machine could not test it.
        """
        if self._unproved is None or give_up():
            return None
        try:
            proved = explained(self._unproved, self._options, tell, build=self.rebuild, give_up=give_up)
        except MachineError:
            self._unproved = None
            return None
        if give_up():
            return None
        self._unproved = None
        return proved if proved.evidence.tries.made else None

    def close(self) -> None:
        """Terminate the waiting processes."""
        if self._warm is not None:
            self._warm[1].close()
            self._warm = None

    def _open(self) -> Submission:
        named = self.exercise.package
        return open_submission(self.folder, named) if named else open_answers(self.folder)

    def _next_trial(self, plan: Plan, ros: Ros, *, in_cell: bool) -> Trial:
        # The next grading will begin with the same trial as this grading.
        if self._wanted is None and plan.clock == "simulated":
            self._wanted = (plan, ros)
        if self._warm is not None and self._warm[0] == plan:
            trial = self._warm[1]
            self._warm = None
            return trial
        return Trial(plan, ros, in_cell=in_cell)
