"""Create the archive for Gradescope's autograder: setup.sh, run_autograder, and the course with the grader."""

from __future__ import annotations

import stat
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING

from grader.checks.exercises import exercise_from, find_exercise
from grader.common.system_errors import path_and_reason
from grader.errors import MachineError, UsageError
from grader.exercise.model import FILE_NAME, course_folder
from grader.exercise.private_checks import sources_of

if TYPE_CHECKING:
    from collections.abc import Iterator

TEMPLATES = Path(__file__).parent / "templates"
SCRIPTS = {"setup.sh": "gradescope-setup.sh", "run_autograder": "gradescope-run_autograder"}
_FILES = ("LICENSE", "Makefile", "README.md", "pyproject.toml", "requirements.lock")
_FOLDERS = ("course", "exercises", "grader")
"""`exercises` has the starting points, with which the cells of a notebook are compared."""
_LEFT_OUT = frozenset({"__pycache__", "tests", "benchmarks"})
_WHEN = (1980, 1, 1, 0, 0, 0)
"""A fixed date, so that equal files always give an equal archive."""


def build_archive(exercise: str, file: Path, checks: Path | None, *, trusted: bool = False) -> None:
    """Write the archive. `checks` is a folder of private checks to include.

    With `trusted`, submissions run even if Gradescope's container does not allow sandboxes.

    Raises:
        UsageError: the exercise does not exist, the private checks are wrong, or this is not a checkout of the course.
        MachineError: the archive cannot be written, or a file of the course cannot be read.
    """
    known = find_exercise(exercise)
    sources = sources_of({known.id}, checks)[known.id]
    exercise_from(sources)  # report mistakes here, not on Gradescope
    root = course_folder().parent
    if not (root / "Makefile").is_file():
        message = f"The archive can be created only in a checkout of the course, but {root} is not a checkout."
        raise UsageError(message)
    try:
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, template in SCRIPTS.items():
                _add(archive, name, (TEMPLATES / template).read_bytes(), executable=True)
            _add(archive, "exercise-id", f"{known.id}\n".encode())
            if trusted:
                _add(archive, "trust-submissions", b"")
            if sources.private is not None:
                _add(archive, f"checks/{known.id}/{FILE_NAME}", sources.private)
            for path in _course(root):
                _add(archive, f"course/{path.relative_to(root).as_posix()}", path.read_bytes(), executable=_runs(path))
    except OSError as error:
        where, reason = path_and_reason(error)
        # A file of the course could be unreadable, too.
        message = f"{file} could not be created: {reason}{f' ({where})' if where not in ('', str(file)) else ''}."
        raise MachineError(message) from error


def _course(root: Path) -> Iterator[Path]:
    """Yield the files of the course that grading needs. Solutions and tests are omitted."""
    yield from (root / name for name in _FILES if (root / name).is_file())
    for folder in _FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            parts = path.relative_to(root).parts
            hidden = any(part.startswith(".") for part in parts)
            if path.is_file() and not hidden and _LEFT_OUT.isdisjoint(parts) and path.suffix != ".pyc":
                yield path


def _runs(path: Path) -> bool:
    return bool(path.stat().st_mode & stat.S_IXUSR)


def _add(archive: zipfile.ZipFile, name: str, content: bytes, *, executable: bool = False) -> None:
    info = zipfile.ZipInfo(name, _WHEN)
    info.external_attr = (stat.S_IFREG | (0o755 if executable else 0o644)) << 16
    info.compress_type = zipfile.ZIP_DEFLATED
    archive.writestr(info, content)
