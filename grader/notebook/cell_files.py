"""The files of a step next to its notebook: copy the files that are missing."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from grader.common import xdg
from grader.exercise.own_numbers import draw_numbers, to_toml
from grader.exercise.starting_point import starting_point
from grader.learner import progress, workspace

if TYPE_CHECKING:
    from pathlib import Path

    from grader.exercise.model import Exercise
    from grader.exercise.own_numbers import NumbersSpec

KEPT = ".kept"
"""If a cell replaces changes of the student that this kernel has not written, the old version of the file is kept in
this folder. The folder is hidden, so its files are not graded."""
SOLUTIONS = "solutions"
"""The folder with the notebooks that contain the solutions. This folder has the same name in the course and in a class
of nbgrader."""


def begin(exercise: Exercise, folder: Path, *, alone: bool = False) -> tuple[str, ...]:
    """Add the step's files that are missing from `folder`, next to the notebook. Return the paths that were written.

    A missing package is copied from the learner's workspace, or else from the starting point. With `alone`, a missing
    package is always copied from the starting point, and the student's individual numbers are not written. Files that
    the student has changed are never overwritten.
    """
    source, target = starting_point(exercise), folder
    if not exercise.package:
        return workspace.add_missing(source, target, {})[0]
    source, target = source / exercise.package, folder / exercise.package
    own = workspace.work_folder(exercise, progress.workspace_of(None))
    written: tuple[str, ...] = ()
    if not alone and not target.exists() and own.is_dir():
        written = workspace.add_missing(own, target, {})[0]
    written += workspace.add_missing(source, target, {})[0]
    # For an instructor who runs the solution's notebook, the file already contains the numbers that the code uses.
    if not alone and exercise.numbers is not None and folder.resolve().parent.name != SOLUTIONS:
        written += _own_numbers(exercise.numbers, source, target)
    return tuple(f"{exercise.package}/{path}" for path in dict.fromkeys(written))


def _own_numbers(spec: NumbersSpec, source: Path, target: Path) -> tuple[str, ...]:
    """Write the student's individual numbers if the file still contains the numbers of the starting point."""
    file = target / spec.file
    if file.read_bytes() != (source / spec.file).read_bytes():
        return ()
    file.write_text(to_toml(draw_numbers(spec, _student())), encoding="utf-8")
    return (spec.file,)


def _student() -> str:
    """Return the student's name in nbgrader: the user name, or JupyterHub's name of the user if the account is jovyan.

    All users of a JupyterHub can share the account jovyan, since each of them has a container.
    """
    name = xdg.user_name()
    return os.environ.get("JUPYTERHUB_USER", name) if name == "jovyan" else name
