"""The executables that a lesson can start with `ros2 run`: those of the step's solution and of turtlesim."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.common.words import a_list
from grader.ros.failure import did_you_mean
from grader.submission.setup_py import read_setup_py

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

TURTLESIM = frozenset({"turtlesim_node", "turtle_teleop_key", "draw_square", "mimic"})

Programs = dict[str, frozenset[str]]


def programs_of(course: Path, step: str | None) -> Programs:
    """Return the executables of each package that a page of the course may start.

    `course` is the folder course/, next to which the solutions are. If `step` is None, or its solution has no package,
    all solutions are used: for each package, the last one that contains it. The result is empty if there are no
    solutions, as in the students' repository.
    """
    solutions = course.parent / "solutions"
    own = dict(_packages(solutions / step)) if step else {}
    every = own or dict(each for folder in sorted(solutions.glob("*")) for each in _packages(folder))
    return {"turtlesim": TURTLESIM, **every} if every else {}


def _packages(folder: Path) -> Iterator[tuple[str, frozenset[str]]]:
    for file in sorted(folder.glob("*/setup.py")):
        setup = read_setup_py(file.read_bytes())
        if setup.entry_points is not None:
            yield setup.name or file.parent.name, frozenset(each.name for each in setup.entry_points)


def why_not_started(package: str, executable: str, programs: Mapping[str, frozenset[str]]) -> str:
    """Return the reason why `ros2 run` cannot start an executable, or an empty string."""
    if not programs or executable in programs.get(package, ()):
        return ""
    if package not in programs:
        known = a_list(sorted(programs), "or")
        return did_you_mean(package, programs, f"the package '{package}' is not {known}.").replace("\n", " ")
    text = f"the package {package} has no executable '{executable}'."
    return did_you_mean(executable, programs[package], text).replace("\n", " ")
