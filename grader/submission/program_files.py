"""The files that the reading process can open besides a submission: files of the system, Python and the course."""

from __future__ import annotations

import os
import sys
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_SYSTEM = ("/usr", "/lib", "/lib64", "/opt/ros", "/etc/ld.so.cache", "/etc/localtime", "/dev/null", "/dev/urandom")
_MODULES = ("site-packages", "dist-packages")
"""Folders with these names, and the folders in them, contain only modules. Other entries of sys.path can be any
folders, such as the current folder or the home folder."""


@cache
def program_files() -> tuple[Path, ...]:
    """Return the files and folders that any reading process may need, for example to import a module."""
    package = Path(__file__).resolve().parents[1]
    lessons = (package.parent / "course", package.parent / "exercises")
    searched = [Path(entry) for entry in sys.path if os.path.isabs(entry)]  # noqa: PTH117
    modules = [path for path in searched if not set(path.parts).isdisjoint(_MODULES)]
    python = (sys.prefix, sys.base_prefix, sys.exec_prefix)
    return (*map(Path, (*_SYSTEM, *python)), *modules, package, *lessons)


def paths_in(values: Iterable[object]) -> Iterator[Path]:
    """Yield the paths among these arguments of a function, including paths inside tuples and lists."""
    for value in values:
        if isinstance(value, Path):
            yield value
        elif isinstance(value, tuple | list):
            yield from paths_in(value)
