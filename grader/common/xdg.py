"""The folders in which a user's programs keep their own files, after the XDG Base Directory Specification 0.8."""

from __future__ import annotations

import os
from pathlib import Path


def cache() -> Path:
    """The folder that this program may fill with what it can make again."""
    return _folder("XDG_CACHE_HOME", ".cache")


def state() -> Path:
    """The folder for what is to outlast this program and cannot be made again."""
    return _folder("XDG_STATE_HOME", ".local/state")


def _folder(variable: str, default: str) -> Path:
    """Ours below the folder that `variable` names; one that is relative is to be ignored as if it were not set."""
    named = os.environ.get(variable, "")
    return (Path(named) if named.startswith("/") else Path.home() / default) / "grader"
