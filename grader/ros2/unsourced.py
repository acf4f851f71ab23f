"""Hints for packages that `ros2` does not find because they are not sourced or not built."""

from __future__ import annotations

import os
import re
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING

from grader.common import xdg
from grader.common.words import nearest, printable
from grader.ros import index
from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

_DEEPEST = 4
"""The number of folder levels below src/ that are searched for packages."""
_MOST = 2000
"""The maximum number of folders of a workspace that are searched."""


def find(package: str, unknown: str) -> None:
    """Raise Ros2Error if the package, or one with a similar name, is in a workspace, but not sourced in this terminal.

    The error message is `unknown` and, on the next line, a hint that says what to type.
    """
    installed = index.packages()
    hint = "" if package in installed else where_it_is(package) or meant(package, installed)
    if hint:
        message = f"{unknown}\n{hint}"
        raise Ros2Error(message)


def where_it_is(package: str) -> str:
    """Return a hint that says where the package is and what to type, or "" if no workspace contains it."""
    for workspace in _workspaces():
        for built in (workspace / "install" / package, workspace / "install"):
            if (built / "share" / package / "package.xml").is_file():
                setup = _shown(workspace / "install/setup.bash")
                return f"The package is built, but not sourced in this terminal. Type: source {setup}"
    for workspace in _workspaces():
        for manifest in _manifests(workspace / "src"):
            if _name(manifest) == package:
                typed = f"cd {_shown(workspace)} && colcon build && source install/setup.bash"
                return f"The package is in {_shown(manifest.parent)}, but not built. Type: {typed}"
    return ""


def meant(package: str, installed: Collection[str]) -> str:
    """Return a hint about the most similar package if that package is in a workspace but not installed, or else ""."""
    unsourced = {_name(manifest) for workspace in _workspaces() for manifest in _manifests(workspace / "src")}
    likely = nearest(package, [*installed, *unsourced])
    if likely is None or likely in installed:
        return ""
    return f"Did you mean '{printable(likely)}'? {where_it_is(likely)}"


def _workspaces() -> Iterator[Path]:
    """Yield possible workspaces: the current folder, its parents, and the workspace of the ROS 2 tutorials."""
    cwd = Path.cwd()
    for folder in dict.fromkeys([cwd, *cwd.parents, xdg.home() / "ros2_ws"]):
        if folder != folder.parent and any((folder / name).is_dir() for name in ("install", "src")):
            yield folder


def _manifests(folder: Path) -> Iterator[Path]:
    for looked, (place, folders, files) in enumerate(os.walk(folder), 1):
        depth = len(Path(place).relative_to(folder).parts)
        if "package.xml" in files:
            yield Path(place, "package.xml")
        if looked >= _MOST:
            return
        if depth >= _DEEPEST or "package.xml" in files or "COLCON_IGNORE" in files:
            folders.clear()
        folders[:] = sorted(name for name in folders if not name.startswith("."))


def _name(manifest: Path) -> str:
    try:
        match = re.search(r"<name>\s*(.*?)\s*</name>", manifest.read_text("utf-8"))
    except (OSError, UnicodeDecodeError):
        return ""
    return match[1] if match else ""


def _shown(path: Path) -> str:
    """Return a path as a user would type it."""
    home = xdg.home()
    return f"~/{quote(str(path.relative_to(home)))}" if path.is_relative_to(home) else quote(str(path))
