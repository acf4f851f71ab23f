"""Measure how long it takes to autograde a notebook and a class, relative to nbgrader and `grader check` alone.

    python -m grader.benchmarks.notebooks [--repeat N] [--class N]

In one run on the same machine, this benchmark measures:

- `nbgrader autograde` of the notebook of step 03 next to the solved package;
- `nbgrader autograde` of the notebook with empty cells, which shows nbgrader's own cost (imports, a kernel, the
  database);
- `grader check` of the package.

Autograding the notebook next to the solved package should take at most 1.5 times as long as the other two measurements
together. After these measurements, a class is measured: nbgrader autogrades the submissions one by one, and `grader
gradebook sync` grades several in parallel.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from grader.common.interpreter import interpreter
from grader.exercise.model import course_folder
from grader.gradebook.new_class import make_class

STEP = "03-circle-publisher"
AT_MOST = 1.5


def seconds(argv: list[str], cwd: Path) -> float:
    """Run a command, and return its duration (s). The output is shown only if the command fails."""
    env = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}", "PYTHONWARNINGS": "ignore"}
    begun = time.monotonic()
    done = subprocess.run(argv, cwd=cwd, env=env, capture_output=True, text=True, check=False)
    took = time.monotonic() - begun
    if done.returncode != 0:
        message = f"{' '.join(argv)}\n{done.stdout[-3000:]}{done.stderr[-3000:]}"
        raise SystemExit(message)
    return took


def nbgrader(root: Path, *words: str) -> float:
    """Run an nbgrader command, and return its duration (s)."""
    return seconds(interpreter("-m", "nbgrader", *words).argv, root / "course")


PLAIN = """\
c = get_config()
c.CourseDirectory.root = {root!r}
c.CourseDirectory.source_directory = "solutions"
c.CourseDirectory.release_directory = "exercises"
c.CourseDirectory.submitted_directory = "class/submitted"
c.GenerateAssignment.force = True
"""
"""The content of an nbgrader_config.py without the grader's additions."""


def make_empty(root: Path) -> None:
    """Create a class that uses nbgrader without the grader, and remove the code from the cells of its notebook."""
    make_class(root, None)
    (root / "course" / "nbgrader_config.py").write_text(PLAIN.format(root=str(root)))
    file = root / "solutions" / STEP / f"{STEP}.ipynb"
    notebook = json.loads(file.read_text())
    notebook["metadata"]["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    for cell in notebook["cells"]:
        _empty(cell)
    file.write_text(json.dumps(notebook))


def _empty(cell: dict[str, Any]) -> None:
    about = cell["metadata"].pop("nbgrader", {})
    if cell["cell_type"] == "code":
        cell["source"] = f"{float(about['points'])}" if about.get("grade") else "pass"
    if about.get("grade"):
        cell["metadata"]["nbgrader"] = about


def hand_in(root: Path, students: int) -> None:
    """Hand in the solution for this number of students. Each copy contains a different comment."""
    node = f"{STEP}/my_robot_controller/my_robot_controller/draw_circle.py"
    solution = (course_folder().parent / "solutions" / node).read_text()
    for number in range(students):
        folder = root / "class" / "submitted" / f"student-{number:02d}" / STEP
        shutil.copytree(root / "exercises" / STEP, folder)
        (folder.parent / node).write_text(f"# {number}\n{solution}")


def sync_s(root: Path, students: int) -> float:
    """Create a class in an empty folder, and autograde its notebooks. Return the duration of the gradebook sync (s)."""
    make_class(root, None)
    nbgrader(root, "generate_assignment", STEP)
    hand_in(root, students)
    nbgrader(root, "autograde", STEP)
    sync = [str(Path(sys.prefix, "bin", "grader")), "gradebook", "sync", "--course", str(root / "course")]
    return seconds(sync, root)


def main() -> None:
    """Measure everything and print a table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--class", dest="students", type=int, default=20)
    options = parser.parse_args()
    grader = str(Path(sys.prefix, "bin", "grader"))
    with tempfile.TemporaryDirectory() as folder:
        whole, bare, many = (Path(folder, name) for name in ("whole", "bare", "many"))
        make_class(whole, None)
        make_empty(bare)
        for root in (whole, bare):
            nbgrader(root, "generate_assignment", STEP)
            hand_in(root, 1)
        package = whole / "class" / "submitted" / "student-00" / STEP
        runs: dict[str, list[float]] = {"autograde": [], "nbgrader's own": [], "grader check": []}
        for _ in range(options.repeat):
            runs["autograde"].append(nbgrader(whole, "autograde", STEP, "--force"))
            runs["nbgrader's own"].append(nbgrader(bare, "autograde", STEP, "--force"))
            runs["grader check"].append(
                seconds([grader, "check", str(package), "--exercise", STEP, "--sandbox"], whole)
            )
        medians = {name: statistics.median(took) for name, took in runs.items()}
        for name, median in medians.items():
            print(f"{name:16} {median:6.2f} s   (from {min(runs[name]):.2f} to {max(runs[name]):.2f})")
        ratio = medians["autograde"] / (medians["nbgrader's own"] + medians["grader check"])
        print(f"{'ratio':16} {ratio:6.2f}     (at most {AT_MOST})")

        if options.students:
            make_class(many, None)
            nbgrader(many, "generate_assignment", STEP)
            hand_in(many, options.students)
            alone = nbgrader(many, "autograde", STEP)
            together = seconds([grader, "gradebook", "sync", "--course", str(many / "course")], many)
            print(f"a class of {options.students}: nbgrader autograde {alone:.1f} s, gradebook sync {together:.1f} s")


if __name__ == "__main__":
    main()
