"""Create the repository for students: the course without the solutions, the tests and the benchmarks."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from grader.authoring.release import release
from grader.checks.exercises import find_exercise
from grader.common.new_folder import new_folder
from grader.errors import UsageError
from grader.exercise.model import catalogue, course_folder

_FILES = ("LICENSE", "Makefile", "pyproject.toml", "requirements.lock", ".gitignore", ".gitattributes", "COLCON_IGNORE")
_PAGES = (
    *("learner.md", "commands.md", "glossary.md", "kinds.md", "ros2-differences.md", "security.md"),
    "sandbox.md",
)
"""The pages of docs/ that students get: those for learners, and those that explain the checks and the sandbox."""
_TARGETS = ("help", "demo", "notebooks", "clean", "python3")
"""The targets of the Makefile for students. They need neither the tests, the solutions nor the other pages."""
_NOT_FOR_STUDENTS = ("tests", "benchmarks", "__pycache__", "*.pyc", "nbgrader_config.py")
_IN_A_WHEEL = ("course", "exercises", "solutions", "repository")
"""Folders that a wheel puts into the package (grader/setup/hatch_build.py). In a checkout, their files are next to the
package."""


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
        (to / "Makefile").write_text(_makefile((files / "Makefile").read_text("utf-8")), encoding="utf-8")
        shutil.copytree(root / "course", to / "course", ignore=shutil.ignore_patterns(*_NOT_FOR_STUDENTS))
        shutil.copytree(package, to / "grader", ignore=skipped)
        (to / "docs").mkdir()
        for name in _PAGES:
            text = (files / "docs" / name).read_text("utf-8")
            (to / "docs" / name).write_text(_without_missing_links(text, to / "docs"), encoding="utf-8")
        for name in catalogue():
            release(root / "solutions" / name, to / "exercises" / name)
        (to / "README.md").write_text(_readme(), encoding="utf-8")


def _makefile(text: str) -> str:
    """Return the Makefile with only the targets for students."""
    parts = text.split("\n\n")
    names = [re.match(r"(?:\.PHONY: .*\n)?([a-z.-]+[a-z0-9]): ", part) for part in parts]
    kept = [part for part, name in zip(parts, names, strict=True) if name is None or name[1] in _TARGETS]
    phony = f".PHONY: {' '.join(_TARGETS)}"
    return re.sub(r"^\.PHONY: help.*$", phony, "\n\n".join(kept), flags=re.MULTILINE)


def _without_missing_links(text: str, folder: Path) -> str:
    """Return a page in which each link to a file that students do not get is replaced with the link's text."""

    def kept(link: re.Match[str]) -> str:
        there = link[2].startswith(("https://", "#")) or (folder / link[2].partition("#")[0]).exists()
        return link[0] if there or (folder / link[2].partition("#")[0]).name in _PAGES else link[1]

    return re.sub(r"\[([^\]]*)\]\(([^)\s]+)\)", kept, text)


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
