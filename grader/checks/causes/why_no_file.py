"""Explain why a file that the node opens does not exist: the build did not install it."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.words import shorten

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

MISSING = re.compile(r"No such file or directory: '(?P<path>[^']+)'")


def why_no_file(scene: CrashScene) -> Cause | None:
    """Return the cause if the node opens a file that the package contains, at a path where it is not installed."""
    found = MISSING.search(scene.crash.message)
    last = found["path"].rpartition("/")[2] if found is not None else ""
    own = next((path for path in sorted(scene.evidence.submission.files) if path.rpartition("/")[2] == last), None)
    if found is None or own is None or own.endswith(".py"):
        return None
    if _is_written(scene, found["path"]):
        text = (
            "The code contains an absolute path, which does not exist on every computer. Install the file with "
            "data_files, and open it in the share folder of the package."
        )
        return Cause("file-not-installed", text)
    if "/share/" in found["path"]:
        text = f"The build does not install {shorten(own)} there. data_files in setup.py lists what is installed."
        return Cause("file-not-installed", text)
    absolute = found["path"].startswith("/")
    why = "not at this path" if absolute else "a node does not run in the folder of its package"
    text = (
        f"The package contains {shorten(own)}, but {why}. Install the file with data_files, and open it in the share "
        "folder of the package."
    )
    return Cause("file-not-installed", text)


def _is_written(scene: CrashScene, path: str) -> bool:
    """Return whether the path is absolute and the code contains it, or the folder with which it begins, as a string."""
    strings = [
        node.value
        for module in scene.evidence.code.modules
        for node in module.nodes
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    ]
    return any(text.startswith("/") and text.count("/") > 1 and path.startswith(text) for text in strings)
