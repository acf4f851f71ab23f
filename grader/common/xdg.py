"""The folders for the grader's own files of a user, as in the XDG Base Directory Specification 0.8."""

from __future__ import annotations

import os
from pathlib import Path


def cache() -> Path:
    """Return the folder for files that the grader can make again."""
    return _folder("XDG_CACHE_HOME", ".cache")


def state() -> Path:
    """Return the folder for files that must be kept and cannot be made again."""
    return _folder("XDG_STATE_HOME", ".local/state")


def _folder(variable: str, default: str) -> Path:
    """Return our folder below the one in `variable`; a relative path is ignored, as the specification asks."""
    named = os.environ.get(variable, "")
    return (Path(named) if named.startswith("/") else Path.home() / default) / "grader"
