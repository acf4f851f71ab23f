"""Submission: the package or the answers.toml that has been found in a student's folder and read."""

from __future__ import annotations

import errno
import hashlib
import os
import posixpath
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.errors import MachineError, UnreadableError, UsageError
from grader.submission import tree
from grader.submission.reader import read
from grader.submission.search import NoPackageError, find_package, why_not_opened
from grader.submission.tree import shown

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

ANSWERS = "answers.toml"
"""The file that contains the answers to an exercise."""
GIVE_ANSWERS = f"Give the folder that contains your {ANSWERS}."
MAX_REJECTED = 20
"""The maximum number of files that `rejected` names. Further files are only counted."""


@dataclass(frozen=True)
class Submission:
    """A package, or an answers.toml if the exercise has no package.

    `package_dir` is the folder of the package, and `files` maps POSIX paths relative to that folder to the contents of
    the files.

    `files` leaves out build/, install/ and log/ (unless they are Python packages), hidden folders, virtual environments
    and caches. A link to another file in the package has the content of that file. `rejected` lists everything that
    makes the submission invalid, each with the reason, for example a device or a symlink that points outside the
    package. Every path in `files` is printable.
    """

    name: str
    """The path as the user specified it. Messages and reports contain this path."""
    package_dir: Path
    """The absolute path of the package, for error messages and the name of the folder. Only `files` are graded."""
    files: Mapping[str, bytes]
    rejected: tuple[str, ...]
    digest: str
    """The SHA-256 hash of the sorted paths and contents of `files`. The hash does not depend on the permissions of the
    files."""
    executable: frozenset[str] = frozenset()
    """The paths in `files` that have the executable bit."""
    student: str | None = None
    """The student, if known (when a class is graded)."""
    remark: str = ""
    """Sentences about notebooks whose cells were not used, or an empty string."""


def open_submission(path: str | os.PathLike[str], package: str = "", *, exactly: bool = False) -> Submission:
    """Read the package in this folder, or the only package in the folders below it.

    If there are several packages, read the one with the name `package`. With `exactly`, the path must not contain a
    link.

    Raises UsageError if there is no such folder or if it does not contain exactly one such package, UnreadableError if
    the folder cannot be read within the limits of `read`, and MachineError if the disk or the system fails. Every other
    problem is the student's fault and is listed in `rejected`.
    """
    return _read(_submission, os.fspath(path), exactly, package)


def _read(function: Callable[..., Submission], name: str, exactly: bool, *wanted: str) -> Submission:
    try:
        return read(function, name, Path(name), exactly, *wanted)
    except UnreadableError as error:
        message = f"{shown(name)} cannot be opened: {error}."
        raise type(error)(message) from error


def _submission(name: str, path: Path, exactly: bool, wanted: str) -> Submission:
    try:
        with _opened(path, exactly) as root:
            package = find_package(root, name, wanted)
            with tree.open_below(root, package) as folder:
                found = tree.read_tree(folder)
    except OSError as error:
        message = why_not_opened(error, name)
        raise UsageError(message) from error
    return Submission(
        name=name,
        package_dir=path.resolve() / package,
        files={path: found.files[path] for path in sorted(found.files, key=tree.sort_key)},
        rejected=_sentences(found.rejected),
        digest=digest(found.files),
        executable=frozenset(found.executable),
    )


@contextmanager
def _opened(path: Path, exactly: bool) -> Iterator[int]:
    with tree.open_folder(os.fspath(path), follow=True) as folder:
        if exactly:
            tree.require_path(folder, path)
        yield folder


def open_answers(path: str | os.PathLike[str], *, exactly: bool = False) -> Submission:
    """Return a submission that contains only the answers.toml of this folder, for an exercise without a package.

    `exactly` has the same meaning as in `open_submission`.

    Raises UsageError if there is no such folder or file. The other exceptions are the same as for `open_submission`.
    """
    return _read(_answers, os.fspath(path), exactly)


def _answers(name: str, path: Path, exactly: bool) -> Submission:
    try:
        with _opened(path, exactly) as root:
            found = tree.read_tree(root)
    except OSError as error:
        message = why_not_opened(error, name, GIVE_ANSWERS)
        raise UsageError(message) from error
    if ANSWERS in found.rejected:
        message = f"{shown(name)}/{ANSWERS} {found.rejected[ANSWERS]}."
        raise UsageError(message)
    if ANSWERS not in found.files:
        message = f"There is no {ANSWERS} in {shown(name)}. {GIVE_ANSWERS}"
        raise NoPackageError(message)
    files = {ANSWERS: found.files[ANSWERS]}
    return Submission(name, path.resolve(), files, (), digest(files))


def digest(files: Mapping[str, bytes]) -> str:
    """Return the SHA-256 hash of paths and contents.

    The length of each path and content is hashed, too. Without it, different files could have the same hash.
    """
    whole = hashlib.sha256()
    for path in sorted(files, key=tree.sort_key):
        for part in (os.fsencode(path), files[path]):
            whole.update(b"%d:" % len(part))
            whole.update(part)
    return whole.hexdigest()


def write_copy(submission: Submission, destination: Path) -> None:
    """Write the files to the new folder `destination`.

    All users can read these files, because student code runs in a cell as another user if root runs the grader.

    Raises UsageError if a path leads out of the folder (in a submission that is not from `open_submission`), and
    MachineError if the folder exists, or the disk is full or cannot be written.
    """
    made: set[Path] = set()
    try:
        _make_folders(destination, made)
        for path, data in submission.files.items():
            if path.startswith("/") or posixpath.normpath(path) != path or path.split("/")[0] == "..":
                message = f"{shown(path)} is not a path inside a package."
                raise UsageError(message)
            target = destination / path
            _make_folders(target.parent, made)
            descriptor = os.open(target, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o600)
            with os.fdopen(descriptor, "wb") as file:
                file.write(data)
                os.fchmod(descriptor, 0o755 if path in submission.executable else 0o644)
    except FileExistsError as error:
        message = (
            f"{error.filename} already exists. A submission must be copied to a new folder, on a case-sensitive file "
            "system."
        )
        raise MachineError(message) from error
    except OSError as error:
        todo = "Free some space and try again." if error.errno in (errno.ENOSPC, errno.EDQUOT) else "Try again."
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
