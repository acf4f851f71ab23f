"""The folders for the files that the grader keeps for a user, following the XDG Base Directory Specification 0.8."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping


def home(env: Mapping[str, str] = os.environ) -> Path:
    """Return the user's home folder. HOME may be unset, empty or relative, as in a cron job or a container.

    In this case, the folder is taken from the user database, or is "/" if the database does not contain the user.
    """
    named = env.get("HOME", "")
    if named.startswith("/"):
        return Path(named)
    import pwd

    try:
        return Path(pwd.getpwuid(os.getuid()).pw_dir)
    except KeyError:
        return Path("/")


def user_name() -> str:
    """Return the user's name, or the user id if the system has no name for it, as in a container."""
    import getpass

    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return str(os.getuid())


def cache() -> Path:
    """Return the folder for files that the grader can create again."""
    return _folder("XDG_CACHE_HOME", ".cache")


def state() -> Path:
    """Return the folder for files that must be kept because the grader cannot create them again."""
    return _folder("XDG_STATE_HOME", ".local/state")


def _folder(variable: str, default: str) -> Path:
    """Return the grader's folder inside the folder that is set in the environment variable.

    If the variable is not set, return the grader's folder inside `default`, a folder in the home folder. As the
    specification requires, a relative path counts as not set.
    """
    named = os.environ.get(variable, "")
    folder = Path(named) if named.startswith("/") else home() / default
    # CMake removes "..", and then the folder in which it installs would have another name than we expect.
    return (folder.resolve() if ".." in folder.parts else folder) / "grader"
