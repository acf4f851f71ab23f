"""Show the progress of a run: a live table on a terminal, or one line per submission elsewhere.

Students choose the names of submissions. `plain` changes these names, so that they cannot control a terminal or a
continuous integration (CI) system.
"""

from __future__ import annotations

import os
import re
import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

from grader.common.words import count, printable
from grader.report.suspicion import suspicions
from grader.report.verdict import tone, verdict

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rich.console import Console, RenderableType

    from grader.classroom.results import Result

SIGNS = {"passed": "✓", "failed": "✗", "error": "!"}
STYLES = {"passed": "green", "failed": "red", "error": "bold magenta"}

Name = tuple[str, str]
"""A student and an exercise."""


class Screen(Protocol):
    """Displays the progress of a run."""

    def show(self, name: Name, text: str) -> None:
        """Show the current stage of a submission."""

    def finished(self, result: Result) -> None:
        """Show the result of a submission."""


def plain(text: str) -> str:
    """Return the text, changed so that it cannot control a terminal or a program that reads logs.

    Control characters become question marks or spaces, and a space separates the characters of `::` and `##`.
    """
    # GitHub executes ::command:: at the beginning of a line and ##[command] anywhere, and Azure Pipelines ##vso[.
    return re.sub("(?<=:)(?=:)|(?<=#)(?=#)", " ", printable(text))


def estimate(done: int, of: int, seconds: float) -> str:
    """Return an estimate of the remaining time, based on the average speed so far ("" if there is no estimate)."""
    if not done or done >= of:
        return ""
    left_s = seconds / done * (of - done)
    return f"about {left_s / 60:.0f} min left" if left_s >= 90 else f"about {left_s:.0f} s left"


@contextmanager
def screen(amount: int, *, several: bool) -> Iterator[Screen]:
    """Yield a display that shows the progress of `amount` submissions.

    If `several` is true, the screen also shows the exercise of each submission.
    """
    if not amount:
        yield Lines(amount, several=several)
    elif sys.stderr.isatty() and not os.environ.get("CI"):
        from rich.console import Console
        from rich.live import Live

        console = Console(stderr=True, highlight=False)
        table = Table(amount, console, several=several)
        with Live(get_renderable=table.render, console=console, refresh_per_second=4, transient=True):
            yield table
    else:
        yield Lines(amount, several=several)


class Lines:
    """Prints one line for each finished submission."""

    def __init__(self, amount: int, *, several: bool) -> None:
        self._amount, self._several, self._done = amount, several, 0
        self._begun = time.monotonic()

    def show(self, name: Name, text: str) -> None:
        """Print nothing."""

    def finished(self, result: Result) -> None:
        """Print the result of the submission."""
        self._done += 1
        left = estimate(self._done, self._amount, time.monotonic() - self._begun)
        rest = f"  ({left})" if left else ""
        print(f"[{self._done}/{self._amount}] {_line(result, self._several)}{rest}", file=sys.stderr, flush=True)


class Table:
    """Shows the submissions that are being graded, with a progress bar below.

    Finished submissions stay above the table.
    """

    def __init__(self, amount: int, console: Console, *, several: bool) -> None:
        self._amount, self._several, self._console = amount, several, console
        self._now: dict[Name, tuple[str, float]] = {}
        self._tones: list[str] = []
        self._begun = time.monotonic()

    def show(self, name: Name, text: str) -> None:
        """Show the current stage of a submission."""
        since = self._now[name][1] if name in self._now else time.monotonic()
        self._now = {**self._now, name: (text, since)}

    def finished(self, result: Result) -> None:
        """Print the result of a submission above the table."""
        from rich.text import Text

        name = (result.student, result.report.exercise)
        self._now = {key: value for key, value in self._now.items() if key != name}
        kind = tone(result.report)
        self._tones.append(kind)
        self._console.print(Text(f"{SIGNS[kind]} {_line(result, self._several)}", style=STYLES[kind]))

    def render(self) -> RenderableType:
        """Return the current content of the display."""
        from rich.console import Group
        from rich.progress_bar import ProgressBar
        from rich.table import Table as Grid
        from rich.text import Text

        now = time.monotonic()
        rows = Grid.grid(padding=(0, 2))
        for (student, exercise), (text, since) in sorted(self._now.items(), key=lambda item: item[1][1]):
            who = f"{student}, {exercise}" if self._several else student
            rows.add_row(Text(plain(who)), Text(plain(text), style="dim"), Text(f"{now - since:.0f} s", style="dim"))
        done = len(self._tones)
        bar = Grid.grid(padding=(0, 1))
        counted = [f"{self._tones.count(kind)} {word}" for kind, word in _WORDS if kind in self._tones]
        parts = [f"{done} of {self._amount}", *counted, estimate(done, self._amount, now - self._begun)]
        bar.add_row(ProgressBar(total=self._amount, completed=done, width=30), Text(" · ".join(filter(None, parts))))
        return Group(rows, bar)


_WORDS = (("passed", "passed"), ("failed", "not passed"), ("error", "not judged"))


def _line(result: Result, several: bool) -> str:
    who = f"{result.student}, {result.report.exercise}" if several else result.student
    return plain(f"{who}: {verdict(result.report)}")


def summary(results: list[Result]) -> str:
    """Return a summary of the class in a few sentences."""
    tones = [tone(result.report) for result in results]
    counted = [f"{tones.count(kind)} {word}" for kind, word in _WORDS if kind in tones]
    judged = [each.report for each, kind in zip(results, tones, strict=True) if kind != "error" and each.report.max]
    shares = [report.points / report.max for report in judged]
    mean = f", {100 * sum(shares) / len(shares):.0f} % of the points on average" if shares else ""
    parts = [f"{count(len(results), 'submission')}: {', '.join(counted)}{mean}."]
    attention = suspicions([(result.report, result.errors) for result in results])
    parts += [
        plain(f"See {result.student} ({result.report.exercise}): {why}.")
        for result, why in zip(results, attention, strict=True)
        if why
    ]
    return "\n".join(parts)
