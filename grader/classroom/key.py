"""The key of a result: everything that the result depends on. If the key changes, the submission is graded again."""

from __future__ import annotations

import hashlib
import os
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import grader

if TYPE_CHECKING:
    from collections.abc import Mapping

_NOT_JUDGING = {"tests", "benchmarks", "__pycache__", "templates"}


@dataclass(frozen=True)
class Key:
    """The values that a result depends on, as strings."""

    submission: str
    """The sha256 of the submission."""
    student: str
    exercise: str
    """The sha256 of exercise.toml, including private checks."""
    grader: str
    """The version of the grader and the first 16 digits of the sha256 of its sources."""
    ros: str
    options: str
    """The clock, the seed, whether the submission ran in a sandbox, and whether likely causes were tested."""

    def to_data(self) -> dict[str, str]:
        """Return the key as a dictionary for the JSON of a result."""
        return asdict(self)


def changed(old: Mapping[str, Any], new: Key) -> tuple[str, ...]:
    """Return the names of the values in which the key differs from `old`, the key in the JSON of a result."""
    return tuple(name for name, value in new.to_data().items() if old.get(name) != value)


@cache
def grader_key() -> str:
    """Return a string that identifies the grader.

    The string consists of the version, and the first 16 digits of the sha256 of all files of the package, except tests,
    benchmarks, templates and compiled modules.
    """
    package = Path(grader.__file__).parent
    whole = hashlib.sha256()
    for folder, inner, names in os.walk(package):
        inner[:] = sorted(set(inner) - _NOT_JUDGING)
        for path in sorted(Path(folder, name) for name in names):
            if path.suffix == ".pyc" or not path.is_file():
                continue
            whole.update(path.relative_to(package).as_posix().encode() + b"\0")
            whole.update(hashlib.sha256(path.read_bytes()).digest())
    return f"{grader.__version__} {whole.hexdigest()[:16]}"
