"""Exercise: what is to be done in a step, read from course/*/exercise.toml."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.errors import MachineError, UsageError
from grader.words import a_list, nearest

if TYPE_CHECKING:
    from collections.abc import Mapping

FILE_NAME = "exercise.toml"

Param = str | float | int | bool | tuple[str, ...]


@dataclass(frozen=True)
class CheckSpec:
    """One `[[check]]`: `params` hold its numbers, with units in their names (`rate_hz`, `radius_m`)."""

    id: str
    kind: str
    title: str
    points: float
    needs: tuple[str, ...]
    hidden: bool
    params: Mapping[str, Param]


@dataclass(frozen=True)
class Scenario:
    """What a trial does: `duration_s` on the trial's clock, then SIGINT."""

    duration_s: float


@dataclass(frozen=True)
class Exercise:
    """A step's exercise. `node` is the node's name without a slash, `executable` the entry point that starts it."""

    id: str
    title: str
    package: str
    executable: str
    node: str
    scenario: Scenario
    checks: tuple[CheckSpec, ...]
    hints: tuple[str, ...]
    folder: Path
    digest: str = ""
    """sha256 of exercise.toml: what the exercise asks for, and how it is judged."""


def course_folder() -> Path:
    """The folder course/: beside the package in a checkout, inside it in an installed wheel.

    Raises MachineError when neither is there.
    """
    package = Path(__file__).resolve().parent
    for folder in (package.parent / "course", package / "course"):
        if any(folder.glob(f"*/{FILE_NAME}")):
            return folder
    message = "The lessons (the folder course/) are missing from this installation of the grader: install it again."
    raise MachineError(message)


def catalogue(course: Path | None = None) -> dict[str, Path]:
    """Every exercise of the course, id -> its exercise.toml, in the order of the lessons; nothing is parsed."""
    folder = course_folder() if course is None else course
    return {file.parent.name: file for file in sorted(folder.glob(f"*/{FILE_NAME}"))}


def find_exercise(name: str, course: Path | None = None) -> Exercise:
    """The exercise with this id, or the only one whose id begins with `name` (as in "03"). Raises UsageError."""
    files = catalogue(course)
    begin = [each for each in files if name and each.startswith(name)]
    if name in files:
        return load_exercise(files[name])
    if len(begin) == 1:
        return load_exercise(files[begin[0]])
    guess = nearest(name, files)
    hint = f"did you mean {guess}? " if guess else ""
    several = f"several exercises begin with {name!r}" if begin else f"there is no exercise {name!r}"
    message = f"{several}: {hint}The exercises are {a_list(begin or list(files))}."
    raise UsageError(message)


def exercise_of_folder(path: Path, course: Path | None = None) -> Exercise | None:
    """The exercise that a folder below exercises/ or solutions/ belongs to; None elsewhere."""
    parts = path.resolve().parts
    files = catalogue(course)
    for parent, name in zip(reversed(parts[:-1]), reversed(parts[1:]), strict=True):
        if parent in ("exercises", "solutions") and name in files:
            return load_exercise(files[name])
    return None


def load_exercise(path: Path) -> Exercise:
    """The exercise in a file, or in the file exercise.toml of a folder.

    Raises UsageError that tells its author every problem: which key, what was seen, what is allowed.
    """
    from grader.exercise_file import parse_exercise

    file = path / FILE_NAME if path.is_dir() else path
    try:
        data = file.read_bytes()
    except OSError as error:
        message = f"{file}: cannot be read ({error.strerror})."
        raise UsageError(message) from error
    return parse_exercise(data, name=str(file), folder=file.parent)
