"""The key of a result: all that it follows from. A result with another key is made again."""

from __future__ import annotations

import hashlib
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import grader

if TYPE_CHECKING:
    from collections.abc import Mapping

_NOT_JUDGING = ("tests", "benchmarks", "__pycache__", "templates")


@dataclass(frozen=True)
class Key:
    """What a result follows from, each as a text."""

    submission: str
    """sha256 of what was handed in."""
    student: str
    exercise: str
    """sha256 of exercise.toml, private checks included."""
    grader: str
    """The grader's version and the sha256 of its sources."""
    ros: str
    options: str
    """Clock, seed, confined or not."""

    def to_data(self) -> dict[str, str]:
        """As it stands in a result's JSON."""
        return asdict(self)


def changed(old: Mapping[str, Any], new: Key) -> tuple[str, ...]:
    """Which parts differ from those in a result's JSON."""
    return tuple(name for name, value in new.to_data().items() if old.get(name) != value)


@cache
def grader_key() -> str:
    """The grader's version and the sha256 of the sources that decide what a report says."""
    folder = Path(grader.__file__).parent
    whole = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        parts = path.relative_to(folder).parts
        if not set(parts).isdisjoint(_NOT_JUDGING) or path.suffix == ".pyc" or not path.is_file():
            continue
        whole.update("/".join(parts).encode() + b"\0")
        whole.update(hashlib.sha256(path.read_bytes()).digest())
    return f"{grader.__version__} {whole.hexdigest()[:16]}"
