"""The learner's workspace. `start` adds the starting point of a step, but never overwrites the learner's files."""

from __future__ import annotations

import errno
import itertools
import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.roots_files import belongs_to_root
from grader.common.whole_file import write_whole
from grader.errors import MachineError, UsageError
from grader.exercise.model import catalogue, course_folder
from grader.exercise.own_numbers import draw_numbers, to_toml
from grader.exercise.starting_point import starting_point
from grader.submission import tree
from grader.submission.answers_toml import FILE as ANSWERS
from grader.submission.search import IGNORE_MARKER

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from grader.exercise.model import Exercise


APART = "apart"
"""The folder in the learner's workspace that contains separate workspaces. colcon must not build these workspaces
together with the learner's packages."""
_PACKAGE_FILES = ("package.xml", "setup.py", "setup.cfg", ANSWERS)
"""Package files to which later steps add lines."""
_ENTRY_POINT = re.compile(r"[\"'](?P<name>[\w.-]+) = [\w.]+:\w+[\"'],?")
_KEYWORD = re.compile(r"(?P<name>\w+)=")
_DEPENDENCY = re.compile(r"<(?P<tag>\w*depend)\b[^>]*>\s*(?P<name>[\w.-]+)\s*</")
_TASK = re.compile(r"(?:#|<!--)\s*(TODO \d+: .+?)\s*(?:-->)?$", re.MULTILINE)


@dataclass(frozen=True)
class Started:
    """The result of `start`. The paths of files are relative to `folder`.

    `earlier` are the files in `added` that belong to an earlier step: their tasks are not part of this step. `kept` is
    the folder to which older work was moved (with --fresh). For each package file that already existed, `lacking`
    has the lines of the step's version that are missing from the file, and `tasks` has the missing tasks (TODO 1: ...).
    If `start` has added no file, `tasks` is empty.
    """

    folder: Path
    added: tuple[str, ...]
    present: tuple[str, ...]
    kept: Path | None = None
    lacking: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    tasks: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    earlier: tuple[str, ...] = ()


def solution(exercise: Exercise) -> Path:
    """Return the folder of the step in solutions/.

    Raises:
        UsageError: this copy of the course has no solutions.
    """
    folder = course_folder().parent / "solutions" / exercise.id
    if not folder.is_dir():
        message = "This copy of the course has no solutions. Your instructor has them."
        raise UsageError(message)
    return folder


def work_folder(exercise: Exercise, workspace: Path) -> Path:
    """Return the folder with the learner's work on a step: the package in src/, or a folder for answers.

    A package that the learner did not write is in a separate workspace: apart/ID/src/PACKAGE.
    """
    if not exercise.package:
        return workspace / "answers" / exercise.id
    return (workspace / APART / exercise.id if exercise.apart else workspace) / "src" / exercise.package


def start(exercise: Exercise, workspace: Path, student: str, *, fresh: bool = False) -> Started:
    """Add the files of the step that are missing from the workspace. With `fresh`, existing work is moved away first.

    If each student has different numbers in this step, a missing file with numbers gets those of `student`.

    Raises:
        UsageError: a file is in the place of a folder, or a folder is in the place of a file.
        MachineError: the workspace cannot be read or written, or the starting point of the step is missing.
    """
    source = starting_point(exercise)
    if exercise.package:
        source = source / exercise.package
    folder = work_folder(exercise, workspace)
    kept = None
    try:
        if exercise.apart:
            _ignored(workspace / APART)
        if fresh and folder.exists():
            kept = _put_aside(folder, workspace)
        own = exercise.numbers
        numbers = {own.file: to_toml(draw_numbers(own, student)).encode()} if own is not None else {}
        added, present = add_missing(source, folder, numbers)
        mine = {path: (folder / path).read_bytes() for path in present if path in _PACKAGE_FILES}
        lacking = lacking_lines(exercise, mine)
        tasks = open_tasks(exercise, mine) if added else {}
        earlier = tuple(path for path in added if _is_of_earlier_step(exercise, source, path))
    except (FileExistsError, NotADirectoryError) as error:
        raise UsageError(_in_the_way(Path(error.filename))) from error
    except OSError as error:
        more = belongs_to_root(Path(error.filename or folder))
        moved = f"Your earlier work is in {kept}." if kept else ""
        said = f"{error.filename or folder} could not be read or written: {error.strerror}."
        message = " ".join(filter(None, [said, more, moved]))
        raise MachineError(message) from error
    return Started(folder, added, present, kept, lacking, tasks, earlier)


def add_missing(source: Path, folder: Path, instead: Mapping[str, bytes]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Copy the files of `source` that are missing from `folder`, except for notebooks.

    `instead` replaces the content of some files. Return the paths that were added, and the paths that were not changed.
    Each file appears with its whole content, even if the process is killed or the disk is full. Raises OSError.
    """
    found = tree.read_folder(source)
    added, present = [], []
    for path in sorted(found.files, key=tree.sort_key):
        if path.endswith(".ipynb"):
            continue
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.is_dir():
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(target))
        if os.path.lexists(target):
            present.append(path)
            continue
        write_whole(target, instead.get(path, found.files[path]), mode=0o755 if path in found.executable else 0o644)
        added.append(path)
    return tuple(added), tuple(present)


def _is_of_earlier_step(exercise: Exercise, source: Path, path: str) -> bool:
    """Return whether the file is a module that contains tasks of an earlier step and that this step does not run.

    Raises OSError.
    """
    module = Path(path)
    if len(module.parts) < 2 or module.suffix != ".py" or module.stem in {each.executable for each in exercise.trials}:
        return False
    content = (source / path).read_bytes()
    names = list(catalogue())
    others = (source.parents[1] / name / source.name / path for name in names[: names.index(exercise.id)])
    return b"TODO" in content and any(other.is_file() and other.read_bytes() == content for other in others)


def lacking_lines(exercise: Exercise, files: Mapping[str, bytes]) -> dict[str, tuple[str, ...]]:
    """Return, for each of the learner's package files, the lines of the step's version that are missing from the file.

    `files` has the content of the learner's files by path. Files that are not in `files` are left out, as are the entry
    points of other steps. For a step with a package of its own, no lines are returned, because the learner's task is to
    change the files of that package.

    Raises:
        OSError: a file of the starting point cannot be read.
    """
    here = {trial.executable for trial in exercise.trials}

    def needed(line: str) -> bool:
        point = _ENTRY_POINT.fullmatch(line)
        return point is None or point["name"] in here

    source = _package_files(exercise, files)
    lacking = {path: _questions if path == ANSWERS else _lacking for path in source}
    found = {path: lacking[path](file, files[path]) for path, file in source.items()}
    return {path: kept for path, lines in found.items() if (kept := tuple(filter(needed, lines)))}


def open_tasks(exercise: Exercise, files: Mapping[str, bytes]) -> dict[str, tuple[str, ...]]:
    """Return the tasks (TODO 1: ...) in the step's package files that are missing from the learner's files.

    `files`, the keys of the result and the exceptions are the same as in `lacking_lines`.
    """
    source = _package_files(exercise, files)
    return {path: tasks for path, file in source.items() if (tasks := _tasks(file, files[path]))}


def _package_files(exercise: Exercise, files: Mapping[str, bytes]) -> dict[str, Path]:
    """Map the path of each package file that the learner also has to the file in the starting point."""
    if not exercise.package or exercise.apart:
        return {}
    source = starting_point(exercise) / exercise.package
    return {path: source / path for path in _PACKAGE_FILES if path in files and (source / path).is_file()}


def lacking_text(path: str, lines: Sequence[str]) -> str:
    """Return the text that tells the learner where to add `lines` in the package file `path`."""
    one = len(lines) == 1
    what, these = ("one more line", "this line") if one else ("more lines", "these lines")
    if all(_ENTRY_POINT.fullmatch(line) for line in lines):
        where = "to the list console_scripts, with a comma after each item"
    elif all(line.startswith("<depend>") for line in lines):
        where = "to your file, next to the other dependencies"
    else:
        where = "to your file"
    return f"This step needs {what} in {path}. Add {these} {where}:"


def _lacking(theirs: Path, mine: bytes) -> tuple[str, ...]:
    """Return the lines of the step's file that are missing from the learner's file.

    Comments, spaces, commas at the end of a line and the kind of quotes are ignored.
    """

    def plain(text: str) -> str:
        return "".join(text.replace("'", '"').split()).rstrip(",")

    known = mine.decode("utf-8", "replace")
    lines = (line.strip() for line in theirs.read_text(encoding="utf-8").splitlines())
    new = (line for line in lines if not line.startswith(("#", "<!--")) and plain(line) not in plain(known))
    return tuple(line for line in new if not _is_own(theirs.name, line, known))


def _is_own(file: str, line: str, known: str) -> bool:
    """Return whether the step does not need `line` of its package file, because the learner's file has its own version.

    A learner may change the name of the maintainer, for example, or declare a package with <exec_depend>. Whoever adds
    a keyword argument to setup.py that is already there gets a SyntaxError.
    """
    if file == "package.xml":
        needed = _DEPENDENCY.search(line)
        if needed is None:
            return "<build_type>" not in line
        enough = ("depend", "exec_depend") if needed["tag"] == "depend" else ()
        declared = _DEPENDENCY.finditer(known)
        return any(each["name"] == needed["name"] and (not enough or each["tag"] in enough) for each in declared)
    if file == "setup.py" and not _ENTRY_POINT.fullmatch(line):
        keyword = _KEYWORD.match(line)
        return keyword is None or re.search(rf"\b{keyword['name']}\s*=[^=]", known) is not None
    return False


def _questions(theirs: Path, mine: bytes) -> tuple[str, ...]:
    """Return the questions in the step's answers.toml for which the learner's file has no line."""
    known = {line.partition("=")[0].strip() for line in mine.decode("utf-8", "replace").splitlines()}
    lines = theirs.read_text(encoding="utf-8").partition("[answers]\n")[2].splitlines()
    kept: list[str] = []
    question: list[str] = []
    for line in filter(None, lines):
        question.append(line)
        if not line.startswith("#"):
            kept += [] if line.partition("=")[0].strip() in known else question
            question = []
    return tuple(kept)


def _tasks(theirs: Path, mine: bytes) -> tuple[str, ...]:
    """Return the tasks in the comments of the step's file that are missing from the learner's file."""
    known = mine.decode("utf-8", "replace")
    tasks = (task.strip() for task in _TASK.findall(theirs.read_text(encoding="utf-8")))
    return tuple(task for task in tasks if task not in known)


def _in_the_way(path: Path) -> str:
    """Return the message for a folder in the place of a file of the step, or for a file in the place of a folder."""
    if path.is_dir():
        return f"{path} is a folder, but the step has a file with this name. Rename the folder."
    file = next((above for above in (path, *path.parents) if above.exists()), path)
    return f"{file} is a file, but it must be a folder. Choose another workspace with --workspace."


def _ignored(folder: Path) -> Path:
    """Create a folder in the workspace that colcon ignores."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / IGNORE_MARKER).touch()
    return folder


def _put_aside(folder: Path, workspace: Path) -> Path:
    aside = _ignored(workspace / "before")
    for number in itertools.count(1):
        target = aside / f"{folder.name}-{number}"
        if not target.exists():
            folder.rename(target)
            return target
    raise AssertionError
