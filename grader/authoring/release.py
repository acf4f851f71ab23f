"""Create exercises/ from solutions/, so that each exercise has a single source.

    python -m grader.authoring.release [--check]

First, source notebooks are updated from the files of the solution and the checks in exercise.toml. Then each marked
region of the solution is replaced with the text that students start from (grader/exercise/markers.py). Notebooks are
converted in the same way as nbgrader converts them (grader/notebook/released.py). All other files are copied. Recorded
bags, and files that would be empty without their solutions, are not written, because students create them.
"""

from __future__ import annotations

import argparse
import ast
import sys
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.checks.exercises import load_exercise
from grader.errors import GraderError, UsageError
from grader.exercise.markers import MEANT, stripped, syntax_of
from grader.exercise.model import FILE_NAME, course_folder
from grader.notebook.released import released_notebook
from grader.notebook.source import refreshed
from grader.submission import tree

if TYPE_CHECKING:
    from collections.abc import Callable

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


RECORDED = (".mcap", "/metadata.yaml")
"""The endings of the paths of files that belong to a bag. These files are not released, because each student records a
new bag."""


@dataclass(frozen=True)
class ReleasedFile:
    """A file as students receive it."""

    data: bytes
    executable: bool


def released(solution: Path) -> dict[str, ReleasedFile]:
    """Return the files that students start from, as a dictionary whose keys are POSIX paths.

    `solution` is the folder of a step in solutions/.

    Raises UsageError, with the file and the line, if a marker is wrong or a released file cannot be parsed.
    """
    files: dict[str, ReleasedFile] = {}
    found = _read(solution)
    # Notebooks come last: `grader release` copies mistakes in the other files into their cells.
    for path in sorted(found.files, key=lambda each: (each.endswith(".ipynb"), tree.sort_key(each))):
        data = release_file(found.files[path], path, f"{solution}/{path}")
        if data is not None:
            files[path] = ReleasedFile(data, path in found.executable)
    return files


def release(solution: Path, to: Path) -> None:
    """Write the files that students start from to the folder `to`, and delete all other files in it.

    Raises the same error as `released`.
    """
    wanted = released(solution)
    present = _read(to) if to.is_dir() else tree.Tree()
    for path in present.files.keys() - wanted.keys():
        (to / path).unlink()
    for path, file in wanted.items():
        if present.files.get(path) != file.data:
            (to / path).parent.mkdir(parents=True, exist_ok=True)
            (to / path).write_bytes(file.data)
        (to / path).chmod(0o755 if file.executable else 0o644)


def refresh_notebook(solution: Path) -> None:
    """Update the source notebook of a step, if there is one, from the step's files and checks.

    Raises:
        UsageError: the notebook or the exercise is invalid.
    """
    for path, data in _fresh_notebooks(solution).items():
        (solution / path).write_bytes(data)


def _fresh_notebooks(solution: Path) -> dict[str, bytes]:
    """Return the up-to-date content of each source notebook that is out of date."""
    exercise_file = solution.parent.parent / "course" / solution.name / FILE_NAME
    if not solution.is_dir() or not exercise_file.is_file():
        return {}
    files = _read(solution).files
    notebooks = [path for path in files if path.endswith(".ipynb") and "/" not in path]
    exercise = load_exercise(exercise_file) if notebooks else None
    fresh = {path: refreshed(files[path], exercise, files, f"{solution}/{path}") for path in notebooks if exercise}
    return {path: data for path, data in fresh.items() if data != files[path]}


def stale(solutions: Path, exercises: Path) -> tuple[str, ...]:
    """Return one message for each outdated source notebook, and for each file that `release` would change."""
    steps = sorted({folder.name for root in (solutions, exercises) for folder in root.iterdir() if folder.is_dir()})
    return tuple(line for step in steps for line in _stale_step(solutions / step, exercises / step))


def _stale_step(solution: Path, exercise: Path) -> list[str]:
    wanted = released(solution) if solution.is_dir() else {}
    present = _read(exercise) if exercise.is_dir() else tree.Tree()
    lines = [
        f"{solution}/{path} does not match the solution's files and exercise.toml."
        for path in _fresh_notebooks(solution)
    ]
    for path in sorted(wanted.keys() | present.files.keys()):
        if path not in present.files:
            lines.append(f"{exercise}/{path} is missing.")
        elif path not in wanted:
            lines.append(f"{exercise}/{path} does not come from a solution. Delete it.")
        elif present.files[path] != wanted[path].data:
            lines.append(f"{exercise}/{path} does not match its solution.")
        elif (path in present.executable) != wanted[path].executable:
            lines.append(f"{exercise}/{path} and its solution differ in the executable bit.")
    return lines


def release_file(data: bytes, path: str, name: str) -> bytes | None:
    """Return the released content of a file, or None if the student creates the file. `name` is for error messages.

    Raises UsageError if a marker is wrong or the released file cannot be parsed.
    """
    if path.endswith(RECORDED):
        return None
    if path.endswith(".ipynb"):
        return released_notebook(data, name)
    syntax = syntax_of(path)
    if syntax is None:
        if MEANT.search(data.decode("utf-8", "replace")):
            message = (
                f"{name}: a file of an unknown type contains a marker. "
                "grader/exercise/markers.py lists the known types."
            )
            raise UsageError(message)
        return data
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        message = f"{name}: not UTF-8 ({error.reason} at byte {error.start})."
        raise UsageError(message) from error
    result = stripped(text, syntax, name)
    if result == text:
        return data
    if not result.strip():
        return None
    _must_parse(result, text, path, name)
    return result.encode()


def _must_parse(result: str, text: str, path: str, name: str) -> None:
    """Raise UsageError if the released file cannot be parsed. `text` is the file before it was released."""
    fault = _fault(result, path)
    if not fault:
        return
    own = _fault(text, path)
    message = f"{name}: the file cannot be parsed: {own}."
    if not own:
        message = f"{name}: the released file cannot be parsed: {fault}. Add a STARTER block below the region."
    raise UsageError(message)


def _fault(text: str, path: str) -> str:
    """Return why a Python, XML or TOML file with this text cannot be parsed, or an empty string."""
    parsers: dict[str, Callable[[str], object]] = {".py": ast.parse, ".xml": ET.fromstring, ".toml": tomllib.loads}
    parse = parsers.get(Path(path).suffix, str)
    try:
        parse(text)
    except (SyntaxError, ET.ParseError, tomllib.TOMLDecodeError) as error:
        return str(error).replace("<unknown>, ", "")
    return ""


def _read(folder: Path) -> tree.Tree:
    found = tree.read_folder(folder)
    for path, why in found.rejected.items():
        message = f"{folder}/{tree.shown(path)} {why}."
        raise UsageError(message)
    return found


def main(arguments: list[str] | None = None) -> int:
    """Run the command. Return the exit code, which is 1 if --check finds something out of date."""
    parser = argparse.ArgumentParser(
        prog="python -m grader.authoring.release", description="Create exercises/ from solutions/."
    )
    parser.add_argument("--check", action="store_true", help="change nothing, and fail if a file is out of date")
    parser.add_argument("--root", type=Path, help="the folder with solutions/ and exercises/ (default: this course)")
    options = parser.parse_args(arguments)
    root = options.root or course_folder().parent
    solutions, exercises = root / "solutions", root / "exercises"
    try:
        if options.check:
            lines = stale(solutions, exercises)
            print(*lines, "Run: python -m grader.authoring.release" if lines else "exercises/ is up to date.", sep="\n")
            return 1 if lines else 0
        for step in sorted(folder for folder in solutions.iterdir() if folder.is_dir()):
            refresh_notebook(step)
            release(step, exercises / step.name)
    except GraderError as error:
        print(error, file=sys.stderr)
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
