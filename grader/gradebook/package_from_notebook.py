"""Complete a submitted package with the files that only its notebook contains.

A student may write a node in a cell and never run the cell, or hand in only the notebook. In these cases, the text of
the cell counts if the file next to the notebook is missing or unchanged from the starting point. No cell is run, and
files that a kernel wrote during autograde are ignored.
"""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING

from grader.gradebook.readable import time_of
from grader.learner.workspace import starting_point
from grader.notebook.cell_files import Part, counts, ended, parts_of, starting_text
from grader.submission import tree
from grader.submission.package import Submission, write_copy
from grader.submission.reader import read
from grader.submission.search import PACKAGE_FILES

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from grader.exercise.model import Exercise


def graded_folder(exercise: Exercise, submitted: Path, together: Path) -> Path:
    """Return the folder to grade: `submitted`, or `together` if the notebook's cells complete the package.

    Raises:
        UnreadableError: the submission cannot be read.
        MachineError: the folder `together` cannot be written.
    """
    if together.exists():
        shutil.rmtree(together)
    whole = read(_together, exercise, submitted)
    if whole is None:
        return submitted
    together.parent.mkdir(parents=True, exist_ok=True)
    write_copy(whole, together)
    return together


def _together(exercise: Exercise, submitted: Path) -> Submission | None:
    """Return the submission together with the files from its notebook.

    Return None if the notebook adds no file, or if a file of the submission cannot be used.
    """
    time_of(submitted)  # raises UnreadableError for an invalid time, at which nbgrader would stop
    found = tree.read_folder(submitted)
    notebook = found.files.get(f"{exercise.id}.ipynb")
    parts = _worked_on(exercise, notebook) if notebook else []
    files = _with(exercise, found.files, parts)
    if files is None or found.rejected:
        return None
    return Submission("", submitted, files, (), "", frozenset(found.executable & files.keys()))


def _worked_on(exercise: Exercise, notebook: bytes) -> list[Part]:
    """Return the files that the notebook's cells write, except files that are unchanged from the starting point."""
    try:
        cells = json.loads(notebook)["cells"]
        sources = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    except (ValueError, KeyError, TypeError, RecursionError):
        return []
    return [part for part in parts_of(sources, exercise) if part.text != _start(exercise, part.path)]


def _start(exercise: Exercise, path: str) -> str | None:
    text = starting_text(exercise, path)
    return None if text is None else ended(text)


def _with(exercise: Exercise, files: Mapping[str, bytes], parts: list[Part]) -> dict[str, bytes] | None:
    """Return the files together with the parts of the notebook that count, or None if no part counts."""
    whole = {path: data for path, data in files.items() if not path.endswith(".ipynb")}
    if parts and exercise.package and not any(path.rpartition("/")[2] in PACKAGE_FILES for path in whole):
        start = tree.read_folder(starting_point(exercise)).files
        whole = {path: data for path, data in start.items() if not path.endswith(".ipynb")} | whole
    counted = [part for part in parts if counts(_text(whole.get(part.path)), _start(exercise, part.path)) == "cell"]
    if not counted:
        return None
    return whole | {part.path: part.text.encode() for part in counted}


def _text(data: bytes | None) -> str | None:
    return None if data is None else data.decode("utf-8", "replace")
