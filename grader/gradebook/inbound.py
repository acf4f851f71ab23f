"""The folders in nbgrader's exchange.

`nbgrader submit` creates one folder per submission, but students can create other folders in the exchange.
"""

from __future__ import annotations

import os
import pwd
import stat
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

WILDCARDS = frozenset("*?[")
"""The special characters of `glob`. The pattern with which nbgrader looks for notebooks contains the names of
folders."""


def why_not(folder: Path, student: str, *, owned: bool) -> str:
    """Return the reason why a folder in the exchange cannot be the submission of a student, or an empty string.

    With `owned`, the folder must belong to the student or to this user, unless the student has no account on this
    machine.
    """
    if not folder.name.isprintable():
        return "the name has characters that cannot be printed"
    if WILDCARDS.intersection(folder.name):
        return "nbgrader would use the name as a pattern for the names of other students"
    try:
        about = folder.lstat()
    except OSError as error:
        return f"it cannot be opened ({error.strerror})"
    if not stat.S_ISDIR(about.st_mode):
        return "it is not a folder"  # a link could lead to the folder of another student
    account = _account(student) if owned else None
    # The collector can hand in work for a student who has lost access.
    if account is not None and about.st_uid not in (account, os.getuid()):
        return f"it does not belong to {student}, but to {owner(folder)}"
    return ""


def owner(folder: Path) -> str:
    """Return the name of the account to which a folder belongs, or a description of the account."""
    user = None
    try:
        user = folder.lstat().st_uid
        return pwd.getpwuid(user).pw_name
    except (OSError, KeyError):
        return "nobody" if user is None else f"the user {user}"


def _account(student: str) -> int | None:
    try:
        return pwd.getpwnam(student).pw_uid
    except KeyError:
        return None
