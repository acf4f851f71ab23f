"""A store on disk for the builds of a learner's package, so that the next `grader check` need not run colcon again.

The store keeps the most recently used builds in the user's cache folder. A file in the store that cannot be read, or is
damaged, is ignored. A build that counts for marks never comes from the store.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import asdict, fields
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.colcon import runner
from grader.colcon.build import Build
from grader.common import xdg

if TYPE_CHECKING:
    from grader.ros.installation import Ros
    from grader.submission.package import Submission

MOST_BUILDS = 20
"""The maximum number of builds in the store. The build that has not been used for the longest time is removed first."""
MOST_BYTES = 4 * 1024 * 1024
"""The maximum size of a file in the store (bytes)."""
_SCHEMA = 1


def build_store() -> BuildStore:
    """Return the store of this user."""
    return BuildStore(xdg.cache() / "builds")


class BuildStore:
    """Builds in a folder, one file per build. The folder is created when the first build is stored."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def get(self, key: str) -> runner.Built | None:
        """Return the build with this key, or None if the store has no such build."""
        path = self._path(key)
        try:
            with path.open("rb") as file:
                built = _unpacked(file.read(MOST_BYTES + 1))
            os.utime(path)
        except (OSError, ValueError, TypeError, KeyError):
            return None
        return built

    def put(self, key: str, built: runner.Built) -> None:
        """Store a build. Nothing is stored if the build is too large, or if the disk is full or not writable."""
        packed = _packed(built)
        if len(packed) > MOST_BYTES:
            return
        with suppress(OSError):
            self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            descriptor, name = tempfile.mkstemp(dir=self._folder)
            try:
                with os.fdopen(descriptor, "wb") as file:
                    file.write(packed)
                Path(name).replace(self._path(key))
            except OSError:
                Path(name).unlink()
                raise
            self._remove_oldest(but=self._path(key))

    def _path(self, key: str) -> Path:
        return self._folder / key

    def _remove_oldest(self, but: Path) -> None:
        used = {path: path.stat().st_mtime_ns for path in self._folder.iterdir()}
        now = time.time_ns()
        # If the system's clock was set back, times in the future count as older than all others.
        by_age = sorted(used, key=lambda path: (path == but, used[path] <= now, used[path]))
        for path in by_age[:-MOST_BUILDS]:
            path.unlink()


def key_of(package: Submission, ros: Ros) -> str:
    """Return a key that changes with everything that affects the install tree of a package in a cell."""
    parts = [_SCHEMA, package.digest, sorted(package.executable), repr(ros), _tools()]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


@cache
def _tools() -> tuple[str, ...]:
    """Return strings that change when Python, its installed packages or the grader's code for builds changes."""
    colcon = find_spec("colcon_core")
    installed = Path(colcon.origin).parents[1] if colcon is not None and colcon.origin is not None else Path(sys.prefix)
    own = hashlib.sha256(
        b"".join(Path(file).read_bytes() for file in (runner.__file__, runner.IN_CELL, *runner.IMPORTED))
    )
    # An installer that adds, updates or removes a package changes the time stamp of the folder.
    return sys.version, str(installed), str(installed.stat().st_mtime_ns), own.hexdigest()


def _packed(built: runner.Built) -> bytes:
    """Return the content of a file in the store: a hash of the rest, the build as one line of JSON, and the tree."""
    content = json.dumps(asdict(built.build)).encode() + b"\n" + built.tree
    return hashlib.sha256(content).hexdigest().encode() + b"\n" + content


def _unpacked(packed: bytes) -> runner.Built:
    """Return the build that was packed.

    Raises:
        ValueError, TypeError or KeyError: the bytes are damaged.
    """
    expected, _, content = packed.partition(b"\n")
    if hashlib.sha256(content).hexdigest().encode() != expected:
        message = "the file is damaged"
        raise ValueError(message)
    described, _, tree = content.partition(b"\n")
    data: dict[str, Any] = json.loads(described)
    values: dict[str, Any] = {field.name: data[field.name] for field in fields(Build)}
    values |= {name: tuple(value) for name, value in values.items() if isinstance(value, list)}
    return runner.Built(Build(**values), tree)
