"""`make notebooks` in a fresh clone: the kernel runs a student's notebook, and nbgrader grades it."""

from __future__ import annotations

import json
import shlex
import shutil
from typing import TYPE_CHECKING

import pytest

from grader.tests.setup.fresh import clone

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = [pytest.mark.exhaustive, pytest.mark.door]
FIRST = "01-first-node"
STEP = "03-circle-publisher"


def test_a_notebook_is_run_and_graded(tmp_path: Path) -> None:
    course = clone(tmp_path)
    said = course.make("notebooks")
    following = [line.strip() for line in said.splitlines()[-2:]]
    assert following == ["source .venv/bin/activate", f"jupyter lab exercises/{FIRST}/{FIRST}.ipynb"]
    assert (course.folder / "exercises" / FIRST / f"{FIRST}.ipynb").is_file()
    assert course.lacks("distributed")
    # The installed kernel executes a student's notebook in a separate folder.
    shutil.copytree(course.folder / "solutions" / STEP, course.home / STEP)
    activate = f"source {shlex.quote(str(course.folder / '.venv/bin/activate'))}"
    course.run(f"{activate} && jupyter execute --inplace {STEP}.ipynb", cwd=course.home / STEP)
    cells = json.loads((course.home / STEP / f"{STEP}.ipynb").read_text("utf-8"))["cells"]
    assert "Passed: 100 of 100 points." in json.dumps(cells)
    # An instructor collects the same notebook.
    course.run("source .venv/bin/activate && grader class new ~/class")
    course.run(f"{activate} && nbgrader generate_assignment {STEP}", cwd=course.home / "class/course")
    shutil.copytree(course.home / STEP, course.home / "class/class/submitted/ada" / STEP)
    grade = f"nbgrader autograde --create {STEP} && grader gradebook sync && nbgrader export"
    course.run(f"{activate} && {grade}", cwd=course.home / "class/course")
    scores = course.run("cut -d, -f4,10,11 grades.csv", cwd=course.home / "class/course")
    assert scores.splitlines()[1:] == ["ada,100.0,100.0"]
