"""Submission: the folder a student hands in, its one package found and read."""

from __future__ import annotations

import errno
import hashlib
import os
import posixpath
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.errors import MachineError, UnreadableError, UsageError
from grader.submission import tree
from grader.submission.reader import read
from grader.submission.search import find_package, why_not_opened
from grader.submission.tree import shown

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

ANSWERS = "answers.toml"
"""What a student writes where questions are asked."""
MAX_REJECTED = 20
"""Lines of `rejected`; the rest is counted."""


@dataclass(frozen=True)
class Submission:
    """`package_dir` is the folder with package.xml or setup.py; `files` its files (POSIX path relative to it -> bytes).

    build/, install/, log/, hidden folders, virtual environments, caches and what is not a regular file inside the
    folder are left out; `rejected` names those that are a fault of the submission (a symlink that leaves it, ...),
    with the reason. A link to another file of the package is that file. Every path in `files` is printable.
    """

    name: str
    """As the user named it."""
    package_dir: Path
    """Absolute. For messages and for the folder's name: what is graded is `files`."""
    files: Mapping[str, bytes]
    rejected: tuple[str, ...]
    digest: str
    """sha256 over the sorted paths and contents of `files`: the same on every machine, whatever the permissions."""
    executable: frozenset[str] = frozenset()
    """The paths of `files` with the executable bit."""
    student: str | None = None
    """Whose it is, where that is known: in a class."""


def open_submission(path: str | os.PathLike[str]) -> Submission:
    """Read the package in the folder, or the only one below it.

    Raises UsageError where there is no such folder, or not exactly one package in it; MachineError where the disk or
    the system fails. Everything else that is odd about the folder is the student's and told in `rejected`.
    """
    return _read(_submission, os.fspath(path))


def _read(function: Callable[[str], Submission], name: str) -> Submission:
    try:
        return read(function, name)
    except UnreadableError as error:
        message = f"{shown(name)} cannot be opened: {error}."
        raise UnreadableError(message) from error


def _submission(name: str) -> Submission:
    try:
        with tree.open_folder(name) as root:
            package = find_package(root, name)
            with tree.open_below(root, package) as folder:
                found = tree.read_tree(folder)
    except OSError as error:
        message = why_not_opened(error, name)
        raise UsageError(message) from error
    return Submission(
        name=name,
        package_dir=Path(name).resolve() / package,
        files={path: found.files[path] for path in sorted(found.files, key=tree.sort_key)},
        rejected=_sentences(found.rejected),
        digest=digest(found.files),
        executable=frozenset(found.executable),
    )


def open_answers(path: str | os.PathLike[str]) -> Submission:
    """Read answers.toml in the folder, and nothing else: what is handed in for an exercise without a package.

    Raises UsageError where there is no such folder, or no such file in it; MachineError where the disk fails.
    """
    return _read(_answers, os.fspath(path))


def _answers(name: str) -> Submission:
    try:
        with tree.open_folder(name) as root:
            found = tree.read_tree(root)
    except OSError as error:
        message = why_not_opened(error, name)
        raise UsageError(message) from error
    if ANSWERS not in found.files:
        why = found.rejected.get(ANSWERS)
        problem = f"{shown(name)}/{ANSWERS} {why}." if why else f"There is no {ANSWERS} in {shown(name)}."
        message = f"{problem} Give the folder that holds your {ANSWERS}."
        raise UsageError(message)
    files = {ANSWERS: found.files[ANSWERS]}
    return Submission(name, Path(name).resolve(), files, (), digest(files))


def digest(files: Mapping[str, bytes]) -> str:
    """The sha256 of paths and contents, each with its length before it, so that no two sets of files run together."""
    whole = hashlib.sha256()
    for path in sorted(files, key=tree.sort_key):
        for part in (os.fsencode(path), files[path]):
            whole.update(b"%d:" % len(part))
            whole.update(part)
    return whole.hexdigest()


def write_copy(submission: Submission, destination: Path) -> None:
    """Write the files as the new folder `destination`, readable by everybody: a sandbox runs as another user.

    Raises UsageError for a path that leaves the folder (a submission that did not come from `open_submission`),
    MachineError where the disk is full or forbids it.
    """
    made: set[Path] = set()
    try:
        _make_folders(destination, made)
        for path, data in submission.files.items():
            if path.startswith("/") or posixpath.normpath(path) != path or path.split("/")[0] == "..":
                message = f"{shown(path)} is no path inside a package."
                raise UsageError(message)
            target = destination / path
            _make_folders(target.parent, made)
            descriptor = os.open(target, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o600)
            with os.fdopen(descriptor, "wb") as file:
                file.write(data)
                os.fchmod(descriptor, 0o755 if path in submission.executable else 0o644)
    except FileExistsError as error:
        message = f"{error.filename} is there already: a copy needs a new folder, on a disk where Case and case differ."
        raise MachineError(message) from error
    except OSError as error:
        todo = "Make room and try again." if error.errno in (errno.ENOSPC, errno.EDQUOT) else "Try again."
        message = f"A copy of the submission could not be written to {destination}: {error.strerror}. {todo}"
        raise MachineError(message) from error


def _make_folders(folder: Path, made: set[Path]) -> None:
    if folder in made:
        return
    if made:
        _make_folders(folder.parent, made)
        folder.mkdir(exist_ok=True)
    else:
        folder.mkdir(parents=True)
    folder.chmod(0o755)
    made.add(folder)


def _sentences(rejected: Mapping[str, str]) -> tuple[str, ...]:
    paths = sorted(rejected, key=tree.sort_key)
    lines = [f"{shown(path)} {rejected[path]}." for path in paths[:MAX_REJECTED]]
    if len(paths) > MAX_REJECTED:
        lines.append(f"And {len(paths) - MAX_REJECTED} more.")
    return tuple(lines)
