"""Create the repository for students: the course without the solutions, the tests and the benchmarks."""

from __future__ import annotations

import shutil
from pathlib import Path

from grader.authoring.release import release
from grader.checks.exercises import find_exercise
from grader.common.new_folder import new_folder
from grader.errors import UsageError
from grader.exercise.model import catalogue, course_folder

_FILES = ("LICENSE", "Makefile", "pyproject.toml", "requirements.lock", ".gitignore", ".gitattributes", "COLCON_IGNORE")
_NOT_FOR_STUDENTS = ("tests", "benchmarks", "__pycache__", "*.pyc")
_IN_A_WHEEL = ("course", "exercises", "solutions", "repository")
"""Folders that are inside the package in a wheel, and next to the package in a checkout (see hatch_build.py)."""


def hand_out(to: Path) -> None:
    """Write the repository for students to the new folder `to`.

    Raises:
        UsageError: the folder is not empty, or this copy of the course has no solutions.
        MachineError: the folder cannot be written.
    """
    root = course_folder().parent
    if not (root / "solutions").is_dir():
        message = f"The repository for students needs solutions/, but {root} does not have this folder."
        raise UsageError(message)
    package = Path(__file__).parent.parent
    files = package / "repository" if (package / "repository").is_dir() else root
    skipped = shutil.ignore_patterns(*_NOT_FOR_STUDENTS, *_IN_A_WHEEL)
    with new_folder(to):
        for name in _FILES:
            shutil.copyfile(files / name, to / name)
        shutil.copytree(root / "course", to / "course", ignore=shutil.ignore_patterns(*_NOT_FOR_STUDENTS))
        shutil.copytree(package, to / "grader", ignore=skipped)
        shutil.copytree(files / "docs", to / "docs", ignore=shutil.ignore_patterns(*_NOT_FOR_STUDENTS))
        for name in catalogue():
            release(root / "solutions" / name, to / "exercises" / name)
        (to / "README.md").write_text(_readme(), encoding="utf-8")


def _readme() -> str:
    steps = "\n".join(
        f"{number}. [{find_exercise(name).title}](course/{name}/lesson.md)"
        for number, name in enumerate(catalogue(), start=1)
    )
    return f"""# ROS 2 topics, graded by doing

You need Linux on x86-64 and Python 3.10 to 3.14. You do not need ROS. Set up once:

    make demo
    source .venv/setup.bash

Then, step by step:

    grader start 01      # puts the step's starting point into ~/ros2_ws
    grader watch         # a verdict after every save; press h for a hint
    grader start next    # when you have passed the step

Or in notebooks: `make notebooks`, then `jupyter lab exercises`. More: [docs/learner.md](docs/learner.md).

{steps}
"""
