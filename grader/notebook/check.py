"""`check("03-circle-publisher")` in a cell: grade the work next to the notebook, and show the verdict below the cell.

The verdict is a table with pictures, or text in a program that cannot show HTML. If nothing has changed, the previous
verdict is returned, so cells that return the points of individual checks are fast.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.common.interpreter import interpreter
from grader.errors import MachineError, UsageError
from grader.notebook.mode import grading

if TYPE_CHECKING:
    from collections.abc import Mapping

    from typing_extensions import Self

    from grader.exercise.model import Exercise
    from grader.notebook.cells import Cells

GRACE_S = 5.0
"""The maximum time for a worker to exit after the cell has been interrupted (s)."""


@dataclass(frozen=True)
class Verdict:
    """The verdict, which Jupyter shows as a table with pictures, and other programs show as text."""

    exercise: str
    text: str
    html: str
    passed: bool
    all_points: Mapping[str, float]
    reasons: Mapping[str, str]

    def points(self, check: str) -> float:
        """Return the points of a check, and print the reason for these points.

        Raises UsageError if the check does not exist.
        """
        if check not in self.all_points:
            message = f"{self.exercise} has no check {check!r}. Its checks: {', '.join(self.all_points)}."
            raise UsageError(message)
        print(self.reasons[check])
        return float(self.all_points[check])

    def __repr__(self) -> str:
        return self.text.rstrip("\n")

    def _repr_html_(self) -> str | None:
        return self.html or None


class Checking:
    """The `check` function of a kernel, with the verdicts of its earlier calls."""

    def __init__(self, cells: Cells) -> None:
        self._cells = cells
        self._known: dict[tuple[str, str], Verdict] = {}

    def check(self, step: str | None = None) -> Verdict:
        """Grade the package (or the answers) next to this notebook. The default exercise is the step of the notebook.

            check("03-circle-publisher").points("circle")

        Raises:
            UsageError: the step does not exist or is not set, no package or answers were found, or the grader reported
                an error.
            MachineError: the grader ended without a verdict and without an error message.
        """
        from grader.notebook.grading_process import opened

        exercise = find_exercise(step) if step else self._cells.current()
        key = exercise.id, opened(exercise, Path.cwd()).digest
        if key not in self._known:
            self._known[key] = _graded(exercise, Path.cwd())
        return self._known[key]


def _graded(exercise: Exercise, folder: Path) -> Verdict:
    with tempfile.TemporaryFile() as answer, _Progress() as progress:
        start = interpreter("-m", "grader.notebook.grading_process", exercise.id, str(folder))
        worker = subprocess.Popen(
            start.argv,
            env=start.env,
            cwd="/",
            stdin=subprocess.DEVNULL,
            stdout=answer,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        lines = []
        try:
            assert worker.stderr is not None
            for line in worker.stderr:
                lines.append(line.decode("utf-8", "replace").strip())
                progress.tell(lines[-1])
            worker.wait()
        finally:
            _end(worker)
        answer.seek(0)
        try:
            data = json.loads(answer.read())
        except ValueError as error:
            message = f"The grader ended without a verdict: {(lines or ['it printed nothing'])[-1]}"
            raise MachineError(message) from error
    if "error" in data:
        raise UsageError(data["error"])
    return Verdict(exercise.id, data["text"], data["html"], data["passed"], data["points"], data["reasons"])


def _end(worker: subprocess.Popen[bytes]) -> None:
    """Stop a worker that is still running: interrupt it, and kill it if it does not exit."""
    for number, wait_s in ((signal.SIGINT, GRACE_S), (signal.SIGKILL, None)):
        if worker.poll() is not None:
            return
        with suppress(ProcessLookupError):
            os.killpg(worker.pid, number)
        with suppress(subprocess.TimeoutExpired):
            worker.wait(wait_s)


class _Progress:
    """A line below the cell that shows the current stage. The line is cleared at the end.

    Nothing is shown when nbgrader executes the notebook.
    """

    def __enter__(self) -> Self:
        from IPython.display import DisplayHandle

        self._handle = None if grading() else DisplayHandle()  # type: ignore[no-untyped-call]
        self._shown = False
        return self

    def tell(self, text: str) -> None:
        """Replace the line."""
        if self._handle is not None and text:
            self._show(f"{text} ...")

    def __exit__(self, *_: object) -> None:
        if self._handle is not None and self._shown:
            self._show("")

    def _show(self, text: str) -> None:
        assert self._handle is not None
        data = {"text/plain": text}
        if self._shown:
            self._handle.update(data, raw=True)  # type: ignore[no-untyped-call]
        else:
            self._handle.display(data, raw=True)  # type: ignore[no-untyped-call]
        self._shown = True
