"""Recognize the folders that this user has created with `grader grade`.

A class folder can contain a folder of results. A student can hand in a folder that looks like one, with forged results
in it. Therefore, a new folder gets a mark that only this user knows.
"""

from __future__ import annotations

import os
import secrets
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common import xdg
from grader.common.whole_file import write_whole

if TYPE_CHECKING:
    from collections.abc import Iterable

MARK = ".grader-results"
"""The name of the file with the mark, which is also the lock of the folder."""
_BYTES = 16


def mark(file: Path, *, needed: bool) -> None:
    """Add a mark to this user's list of marks, and write it to the new file, completely or not at all.

    Raises OSError if the file cannot be written or, if the list is `needed`, if the list cannot be written.
    """
    made = secrets.token_hex(_BYTES)
    try:
        known = _known()
        known.parent.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(known, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        with os.fdopen(descriptor, "w", encoding="ascii") as opened:
            opened.write(f"{made}\n")
    except OSError:
        if needed:
            raise
    write_whole(file, made.encode("ascii"))


def has_results(folder: Path) -> bool:
    """Return whether this user has created the folder with `grader grade`. For a link to its mark, the result is False.

    A folder that cannot be read has no results.
    """
    file = folder / MARK
    try:
        if file.is_symlink() or not file.is_file() or file.stat().st_size != 2 * _BYTES:
            return False
        return file.read_text("ascii") in _known().read_text("ascii").splitlines()
    except (OSError, UnicodeDecodeError):
        return False


def is_among(folder: Path, others: Iterable[Path]) -> bool:
    """Return whether `folder` is in one of the other folders.

    If `folder` itself is a link, the location of the link counts, not the location of its target.
    """
    place = Path(os.path.realpath(folder.parent))
    return any(place.is_relative_to(os.path.realpath(each)) for each in others)


def is_same(one: Path, other: Path) -> bool:
    """Return whether the two paths lead to the same file or folder. A loop of symbolic links is not an error.

    If `one` is a link to `other`, the result is False: a student may have created the link to avoid being graded.
    """
    if os.path.islink(one):  # noqa: PTH114 - before Python 3.14, Path.is_symlink can raise an exception
        return _without_links_above(one) == _without_links_above(other)
    return os.path.realpath(one) == os.path.realpath(other)


def _without_links_above(path: Path) -> Path:
    return Path(os.path.realpath(path.absolute().parent), path.name)


def _known() -> Path:
    return xdg.state() / "results"
