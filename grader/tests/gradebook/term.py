"""A class with the real nbgrader: the commands of an instructor, and the submissions of students."""

from __future__ import annotations

import csv
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.exercise.model import course_folder
from grader.gradebook.new_class import make_class
from grader.tests.gradebook.nbgrader_command import nbgrader

if TYPE_CHECKING:
    from collections.abc import Callable

STEP = "03-circle-publisher"
SOLUTION = course_folder().parent / "solutions" / STEP
NODE = "my_robot_controller/my_robot_controller/draw_circle.py"
FIRST, LATER = "2027-03-01 10:00:00 UTC", "2027-03-02 10:00:00 UTC"

Notebook = dict[str, Any]


class Term:
    """A class in a separate folder, with a separate exchange."""

    def __init__(self, folder: Path, step: str = STEP, *, cell_s: int = 60) -> None:
        """Create the class. `cell_s` is the time limit for a student's cell, which a busy machine must not exceed."""
        self.step = step
        self.root = folder / "course-of-2027"
        self.exchange = folder / "exchange"
        self.exchange.mkdir()
        self.exchange.chmod(0o777)
        make_class(self.root, None)
        self.course = self.root / "course"
        with (self.course / "nbgrader_config.py").open("a") as config:
            config.write(
                f"get_config().Exchange.root = {str(self.exchange)!r}\n"
                f"get_config().ConfinedExecute.cell_s = {cell_s}\n"
                "get_config().LateSubmissionPlugin.penalty_method = 'zero'\n"
            )

    def run(self, *command: str, fails: bool = False, cwd: Path | None = None) -> str:
        """Run a command of nbgrader, or of the grader if the first word is "grader".

        Return the output and the errors of the command.
        """
        path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
        if command[0] == "grader":
            argv = [sys.executable, "-m", "grader.cli", *command[1:], "--course", str(self.course)]
            env = {**os.environ, "PATH": path, "PYTHONWARNINGS": "ignore"}
            done = subprocess.run(
                argv, cwd=cwd or self.course, capture_output=True, text=True, env=env, check=False, timeout=1800
            )
            code, said = done.returncode, done.stdout + done.stderr
        else:
            code, said = nbgrader(*command, cwd=cwd or self.course, PATH=path)
        assert (code != 0) == fails, f"{' '.join(command)}: {code}\n{said[-6000:]}"
        return said

    def generate(self) -> None:
        """Generate the assignment and release it to the exchange."""
        self.run("generate_assignment", self.step)
        self.run("release_assignment", self.step)

    def hand_in(self, student: str, change: Callable[[Path], None], at: str = FIRST) -> None:
        """Apply `change` to a copy of the released folder, and put it into the exchange as `nbgrader submit` does."""
        folder = self.exchange / self.root.name / "inbound" / f"{student}+{self.step}+{at}"
        shutil.copytree(self.root / "exercises" / self.step, folder)
        change(folder)
        (folder / "timestamp.txt").write_text(at)

    def submit(self, student: str, change: Callable[[Path], None]) -> None:
        """Apply `change` to a copy of the released folder, in the folder of the collected submissions."""
        folder = self.root / "class" / "submitted" / student / self.step
        shutil.copytree(self.root / "exercises" / self.step, folder)
        change(folder)

    def grade(self) -> str:
        """Collect, autograde and sync the submissions, and generate the feedback. Return the output of sync."""
        self.run("collect", self.step, "--update")
        self.run("autograde", self.step)
        said = self.run("grader", "gradebook", "sync", self.step)
        self.run("generate_feedback", self.step)
        return said

    def exported(self) -> dict[str, tuple[float, float, float]]:
        """Map each student to (raw score, penalty, score), as written by `nbgrader export`."""
        file = self.root / "grades.csv"
        self.run("export", "--to", str(file))
        with file.open(newline="") as opened:
            return {
                row["student_id"]: (float(row["raw_score"]), float(row["late_submission_penalty"]), float(row["score"]))
                for row in csv.DictReader(opened)
            }

    def gradebook(self) -> Any:  # noqa: ANN401 - nbgrader's, which has no types
        """Return nbgrader's gradebook, which is a context manager."""
        from nbgrader.api import Gradebook

        return Gradebook(f"sqlite:///{self.root}/class/gradebook.db", self.root.name)

    def feedback(self, student: str) -> str:
        """Return the HTML of the feedback."""
        return (self.root / "class" / "feedback" / student / self.step / f"{self.step}.html").read_text("utf-8")


def solve(folder: Path) -> None:
    """Copy the node of the solution into the package."""
    (folder / NODE).write_bytes((SOLUTION / NODE).read_bytes())


def too_slow(folder: Path) -> None:
    """Copy the node of the solution with half the speed, for 55 of 100 points."""
    text = (SOLUTION / NODE).read_text().replace("linear.x = 2.0", "linear.x = 1.0")
    (folder / NODE).write_text(text)


def unchanged(_: Path) -> None:
    """Hand in the starting point, for 15 of 100 points."""


def edit(folder: Path, change: Callable[[list[Notebook]], list[Notebook]]) -> None:
    """Change the notebook's cells."""
    file = folder / f"{STEP}.ipynb"
    notebook = json.loads(file.read_text())
    notebook["cells"] = change(notebook["cells"])
    file.write_text(json.dumps(notebook))


def with_cell(folder: Path, source: str) -> None:
    """Insert a cell after the cell that loads the extension."""
    cell: Notebook = {
        "cell_type": "code",
        "id": "mine",
        "metadata": {},
        "source": source,
        "outputs": [],
        "execution_count": None,
    }
    edit(folder, lambda cells: [*cells[:2], cell, *cells[2:]])
