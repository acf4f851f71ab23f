"""The screen and the keys of `grader watch`."""

from __future__ import annotations

from contextlib import closing, contextmanager
from typing import TYPE_CHECKING

from rich.console import Console

from grader.errors import GraderError, UsageError
from grader.grading.options import Options
from grader.learner import hints, steps
from grader.learner.key_presses import single_keys
from grader.learner.watch import Events, Watched
from grader.report import terminal
from grader.sandbox import bubblewrap

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from grader.exercise.model import Exercise
    from grader.report.report import Report

BELOW = 5
"""The number of lines that are reserved below a report: for the watched folder, the keys, and the text after a key
press."""
KEYS = "h hint · l list · n next · r rerun · q quit"


def run(exercise: Exercise, folder: Path, workspace: Path | None) -> None:
    """Grade now and after every save, until the user presses q or Ctrl-C, or the terminal is closed.

    Raises:
        UsageError: the folder does not exist.
    """
    if not folder.is_dir():
        message = f"There is no folder {folder}. Start a step with `grader start`, or name the folder of your package."
        raise UsageError(message)
    console = Console(highlight=False)
    options = Options(in_cell=bubblewrap.usable())
    with single_keys() as read_key, closing(Events(read_key)) as events:
        notice = ""
        while True:
            screen = _Screen(exercise, folder, workspace, options, console)
            events.watch(folder)
            with closing(screen.watched):
                begun = screen.show(events, notice)
            if begun is None:
                return
            exercise, folder, notice = begun.exercise, begun.started.folder, steps.begin_message(begun)


class _Screen:
    """One exercise on the screen."""

    def __init__(
        self, exercise: Exercise, folder: Path, workspace: Path | None, options: Options, console: Console
    ) -> None:
        self.watched = Watched(exercise, folder, options)
        self._exercise = exercise
        self._workspace = workspace
        self._console = console
        self._shown: Report | None = None
        self._below: list[str] = []
        """The text that was printed below the report."""
        self._asked = False
        """Whether the keys h or l have printed text since the last report. This text must stay on the screen."""

    def show(self, events: Events, notice: str) -> steps.Begun | None:
        """Show reports until the learner quits or starts another step.

        Return the step that the learner has started, or None if the learner has quit.

        On a terminal, each grading clears the screen. `notice` is printed below the first report.
        """
        self._grade(notice)
        self._prove(events)
        for happened in events:
            if happened.kind == "saved":
                if self.watched.changed():
                    self._grade()
            elif happened.key == "r":
                self._grade()
            elif happened.key == "h":
                self._hint()
            elif happened.key == "l":
                self._list()
            elif happened.key == "n":
                begun = self._next()
                if begun is not None:
                    return begun
            elif happened.key in ("q", "\x04"):
                return None
            self._prove(events)
        return None

    def _grade(self, notice: str = "") -> None:
        self._shown, self._below, self._asked = None, [], False
        if self._console.is_terminal:
            self._console.clear()
        # Continue watching even if the progress cannot be written.
        try:
            with self._working() as tell:
                graded = self.watched.grade(tell)
            self._shown = graded.report
            self._render(graded.report, len(notice.splitlines()))
            following = steps.note(self._exercise, self.watched.folder, graded.report, self._workspace)
            if following:
                self._say(following)
        except GraderError as error:
            self._say(str(error))
        if notice:
            self._say(f"\n{notice}")
        self._say(f"\nWatching {self.watched.folder}   {KEYS if self._console.is_terminal else ''}".rstrip())
        self.watched.prepare()

    def _prove(self, events: Events) -> None:
        """While no events are pending, test fixes for the causes in the last report, and show the results."""
        if not self.watched.unproved:
            return
        with self._working() as tell:
            proved = self.watched.prove(tell, events.waiting)
        if proved is None or self._shown is None:
            return
        if self._console.is_terminal and not self._asked:
            self._console.clear()
            self._render(proved.report, sum(text.count("\n") + 1 for text in self._below) - BELOW)
            below, self._below = self._below, []
            for text in below:
                self._say(text)
        else:
            terminal.render_changes(self._shown, proved.report, self._console)
        self._shown = proved.report

    def _render(self, report: Report, more: int) -> None:
        """Print the report, or a brief report if the full one and the lines below it do not fit into the terminal."""
        with self._console.capture() as whole:
            terminal.render(report, self._console)
        fits = whole.get().count("\n") + more + BELOW <= self._console.height
        terminal.render(report, self._console, brief=self._console.is_terminal and not fits)

    def _list(self) -> None:
        self._asked = True
        try:
            steps.print_status(self._workspace, self._console)
        except GraderError as error:
            self._say(str(error))

    def _hint(self) -> None:
        try:
            notice = hints.hint(self._exercise.id, self._workspace)
        except GraderError as error:
            notice = str(error)
        self._asked = True
        self._console.print(notice, markup=False, soft_wrap=not self._console.is_terminal)

    def _next(self) -> steps.Begun | None:
        try:
            return steps.start("next", self._workspace)
        except GraderError as error:
            self._say(str(error))
            return None

    @contextmanager
    def _working(self) -> Iterator[Callable[[str], None]]:
        if not self._console.is_terminal:
            yield lambda _: None
            return
        with self._console.status("Reading") as status:
            yield lambda text: status.update(f"{text} ...")

    def _say(self, text: str) -> None:
        self._below.append(text)
        self._console.print(text, markup=False, soft_wrap=True)
