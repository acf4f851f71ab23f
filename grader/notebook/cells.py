"""The magics for cells: `%step`, `%lesson`, `%%node`, `%%package`, `%%answers` and `%ros2`."""

from __future__ import annotations

import itertools
import shlex
import shutil
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.common.words import a_list
from grader.errors import UsageError
from grader.notebook import cell_files, lesson
from grader.notebook.mode import grading
from grader.submission import notebook_cells

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.exercise.model import Exercise


class Cells:
    """The implementation of the magics. The kernel's current folder is the folder of the notebook."""

    def __init__(self) -> None:
        self.exercise: Exercise | None = None
        self._written: dict[Path, str] = {}

    def step(self, line: str) -> None:
        """`%step 03-circle-publisher`: set the step of this notebook, and add missing files next to it."""
        self.exercise = find_exercise(line.strip())
        try:
            written = cell_files.begin(self.exercise, Path.cwd(), alone=grading())
        except OSError as error:
            message = f"{error.filename or Path.cwd()} could not be written: {error.strerror}."
            raise UsageError(message) from error
        if not grading():
            print(f"{self.exercise.id}: {self.exercise.title}")
            if written:
                print(f"Added next to this notebook: {a_list(written)}.")

    def lesson(self, line: str) -> None:
        """`%lesson`: show the lesson of the step that this notebook is for.

        `%lesson 03-circle-publisher`: show the lesson of that step.
        """
        exercise = find_exercise(line.strip()) if line.strip() else self.current()
        if not grading():
            lesson.show(exercise.folder / "lesson.md")

    def node(self, line: str, cell: str) -> None:
        """`%%node draw_circle.py`: write the content of the cell to a node file of the package next to the notebook."""
        self._write("node", line, cell)

    def package(self, line: str, cell: str) -> None:
        """`%%package package.xml`: write the content of the cell to a file of the package next to the notebook."""
        self._write("package", line, cell)

    def answers(self, line: str, cell: str) -> None:
        """`%%answers`: write the content of the cell to the step's answers.toml."""
        self._write("answers", line, cell)

    def ros2(self, line: str) -> None:
        """`%ros2 topic list`, or just `ros2 topic list`: run the command and show its output below the cell.

        Nothing is run when nbgrader executes the notebook, because nobody reads the output.
        """
        if grading():
            return
        try:
            words = shlex.split(line)
        except ValueError as error:
            message = f"The command has a quote that is not closed, or ends with a backslash: {line}."
            raise UsageError(message) from error
        run_below([str(Path(sys.prefix, "bin", "ros2")), *words])

    def current(self) -> Exercise:
        """Return the step that this notebook is for. Raises UsageError if `%step` has not been run."""
        if self.exercise is None:
            message = "The notebook's step is not set. Run the first cell, for example `%step 03-circle-publisher`."
            raise UsageError(message)
        return self.exercise

    def _write(self, magic: str, line: str, cell: str) -> None:
        exercise = self.current()
        path = notebook_cells.part_path(magic, line.strip(), exercise)
        file, text, start = Path.cwd() / path, notebook_cells.ended(cell), notebook_cells.starting_text(exercise, path)
        present = file.read_text("utf-8", "replace") if file.is_file() else None
        if present is not None and notebook_cells.ended(present) == text:
            self._written[file] = text
            self._say(f"{path} already has this content.")
            return
        worked_on = notebook_cells.counts(present, start) == "file"
        if worked_on and (grading() or (start is not None and text == notebook_cells.ended(start))):
            self._say(
                f"{path} contains your work. The file stays unchanged, because this cell still contains the "
                "starting point."
            )
            return
        if worked_on and self._written.get(file) != present:
            self._say(f"{path} has content that this kernel did not write. The old version is kept in {_keep(file)}.")
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        except OSError as error:
            message = f"{path} could not be written: {error.strerror}."
            raise UsageError(message) from error
        self._written[file] = text
        self._say(f"Written: {path}")

    @staticmethod
    def _say(text: str) -> None:
        if not grading():
            print(text)


def run_below(
    argv: list[str], *, cwd: Path | None = None, env: Mapping[str, str] | None = None, seconds: float | None = None
) -> int:
    """Run a command and print its output until the command exits, `seconds` have passed, or the cell is interrupted.

    Return the exit code of the command.
    """
    child = subprocess.Popen(
        argv, cwd=cwd, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        encoding="utf-8", errors="replace", bufsize=1, start_new_session=True,
    )  # fmt: skip
    assert child.stdout is not None
    alarm = _Alarm(child, seconds)
    try:
        for line in child.stdout:
            print(line, end="", flush=True)
        return child.wait()
    except KeyboardInterrupt:
        child.send_signal(signal.SIGINT)
        with suppress(subprocess.TimeoutExpired):
            child.wait(3.0)
        raise
    finally:
        alarm.cancel()
        if child.poll() is None:
            child.kill()
            child.wait()


class _Alarm:
    """Sends SIGINT (like Ctrl-C) to a child process after some seconds, and kills it if it does not exit."""

    def __init__(self, child: subprocess.Popen[str], seconds: float | None) -> None:
        from threading import Timer

        self._timer = None if seconds is None else Timer(seconds, self._ring, [child])
        if self._timer is not None:
            self._timer.daemon = True
            self._timer.start()

    @staticmethod
    def _ring(child: subprocess.Popen[str]) -> None:
        child.send_signal(signal.SIGINT)
        try:
            child.wait(5.0)
        except subprocess.TimeoutExpired:
            child.kill()

    def cancel(self) -> None:
        if self._timer is not None:
            self._timer.cancel()


def _keep(file: Path) -> str:
    folder = Path.cwd() / cell_files.KEPT
    folder.mkdir(exist_ok=True)
    for number in itertools.count(1):
        target = folder / f"{file.stem}-{number}{file.suffix}"
        if not target.exists():
            shutil.copy2(file, target)
            return f"{cell_files.KEPT}/{target.name}"
    raise AssertionError
