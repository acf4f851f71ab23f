"""Find and load exercises: by their id, by a path, or from a folder in exercises/ or solutions/."""

from __future__ import annotations

import errno
from typing import TYPE_CHECKING

from grader.common.system_errors import of_the_machine
from grader.common.updated import START_AGAIN, updated
from grader.common.words import a_list, nearest
from grader.errors import MachineError, UsageError
from grader.exercise.exercise_toml import parse_exercise
from grader.exercise.model import FILE_NAME, Exercise, catalogue
from grader.exercise.tables import read_toml

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from grader.exercise.private_checks import Sources


def find_exercise(name: str, course: Path | None = None, *, outline: bool = False) -> Exercise:
    """Return the exercise with the id `name`, or the only exercise whose id starts with `name`.

    The names "3" and "03" mean the same exercise. For `outline`, see `load_exercise`.

    Raises UsageError if no exercise or more than one exercise matches, or if its exercise.toml has an error.
    """
    files = catalogue(course)
    name = name.lstrip("0").zfill(2) if name.isascii() and name.isdigit() else name
    begin = [each for each in files if name and each.startswith(name)]
    if name in files:
        return _load(files, name, outline=outline)
    if len(begin) == 1:
        return _load(files, begin[0], outline=outline)
    guess = _nearest(name, files)
    hint = f"Did you mean {guess}? " if guess else ""
    several = f"several exercises start with {name!r}" if begin else f"there is no exercise {name!r}"
    named = begin or list(files)
    known = f"The {'exercises are' if len(named) > 1 else 'exercise is'} {a_list(named, most=len(named))}."
    message = f"{several}. {hint}{known if named else 'The course has no exercises.'}"
    raise UsageError(message)


def _nearest(name: str, known: Iterable[str]) -> str | None:
    """Return the id that this name probably means, or None.

    The name may contain a typo or a letter that looks like a digit (O, I or l), or it may be one word of the id.
    """
    number = name.translate(str.maketrans("OoIl", "0011"))
    same = [each for each in known if name and (name.lower() in each.split("-") or each.startswith(f"{number}-"))]
    return nearest(name, known) or (same[0] if len(same) == 1 else None)


def exercise_of_folder(path: Path, course: Path | None = None) -> Exercise | None:
    """Return the exercise of a folder below exercises/ or solutions/, or None for any other folder."""
    parts = path.resolve().parts
    files = catalogue(course)
    for parent, name in zip(reversed(parts[:-1]), reversed(parts[1:]), strict=True):
        if parent in ("exercises", "solutions") and name in files:
            return _load(files, name)
    return None


def _load(files: Mapping[str, Path], name: str, *, outline: bool = False) -> Exercise:
    """Return the exercise in the folder `name` of the course.

    Raises UsageError if its exercise.toml has an error, or if its id is not this name.
    """
    exercise = load_exercise(files[name], outline=outline)
    if exercise.id != name:
        message = f'{files[name]}: the id is "{exercise.id}", but it must be the name of the folder, "{name}".'
        raise UsageError(message)
    return exercise


def load_exercise(path: Path, *, outline: bool = False) -> Exercise:
    """Return the exercise that the file `path` defines. If `path` is a folder, its file exercise.toml is read.

    If `outline` is True, the parameters of the checks are not read. The module of
    a kind is then imported only for a check without a title, so loading step 03 is more than ten times as fast.

    Raises UsageError, which says why the file cannot be read, or lists every problem in it: the key, its value, and the
    allowed values. Raises MachineError if the course was updated since this process was started, and OSError if the
    machine is at fault, for example because of a read error.
    """
    from grader.checks.kinds import KINDS, OUTLINES  # imported here: a list of exercises does not need it

    file = path / FILE_NAME if path.is_dir() else path
    try:
        data = file.read_bytes()
    except OSError as error:
        if of_the_machine(error) or error.errno == errno.EPERM:
            raise  # a file without read permission has EACCES; EPERM means that the machine forbids the call
        message = f"{file}: cannot be read ({error.strerror})."
        raise UsageError(message) from error
    try:
        return parse_exercise(data, name=str(file), folder=file.parent, kinds=OUTLINES if outline else KINDS)
    except UsageError as error:
        if updated():  # the file may use what only the new version knows
            raise MachineError(START_AGAIN) from error
        raise


def title_of(path: Path) -> str:
    """Return the title of the exercise in a file exercise.toml. If possible, parse only the beginning of the file.

    Raises UsageError, which lists every problem in the file, or OSError if the file cannot be read.
    """
    head = path.read_bytes().partition(b"\n[[")[0]
    try:
        return str(read_toml(head, str(path))["exercise"]["title"])
    except (UsageError, KeyError, TypeError):  # TypeError: exercise is not a table
        return load_exercise(path).title


def exercise_from(sources: Sources) -> Exercise:
    """Return an exercise of the course with the private checks of an instructor, if there are any.

    Raises UsageError, which lists every problem in the files.
    """
    from grader.checks.kinds import KINDS

    return sources.exercise(catalogue()[sources.id].parent, KINDS)
