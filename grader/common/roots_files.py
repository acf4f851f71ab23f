"""A sentence about files of root in the home of an ordinary user, as a command with sudo creates them."""

from __future__ import annotations

import os
from shlex import quote
from typing import TYPE_CHECKING

from grader.common import xdg

if TYPE_CHECKING:
    from pathlib import Path

_ROOT = 0
"""The user id of root."""


def belongs_to_root(path: Path) -> str:
    """Return a sentence with the command to type if root owns a file in the home of this user that is not root.

    The file is `path` or, if it does not exist, the nearest folder above it. If root does not own it, return "".
    """
    # Path.exists raises PermissionError below a folder that cannot be opened.
    there = next(above for above in (path, *path.parents) if os.path.exists(above))  # noqa: PTH110
    home = xdg.home()
    if os.getuid() == _ROOT or home == home.parent or home not in there.parents or not _is_roots(there):
        return ""
    first = there
    while first.parent != home and _is_roots(first.parent):
        first = first.parent
    return (
        f"{there} belongs to root, as after a command with sudo. Type: "
        f"sudo chown -R {os.getuid()}:{os.getgid()} {quote(str(first))}"
    )


def _is_roots(path: Path) -> bool:
    return path.stat().st_uid == _ROOT
