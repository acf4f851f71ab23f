"""The ROS 2 programs of this user that Ctrl-Z has stopped: other programs do not find their nodes."""

from __future__ import annotations

import os
import re
from pathlib import Path

_EXECUTABLE = re.compile(rb"/lib/[\w-]+/(?P<name>[\w-]+)$")
_OUR_TURTLESIM = b"grader.view.turtlesim_node"


def stopped_sentence() -> str:
    """Return a sentence about a stopped program in this ROS domain, or "" if there is none."""
    for name, pid in stopped_programs(os.environ.get("ROS_DOMAIN_ID") or "0"):
        return f"{name} (process {pid}) is stopped, as Ctrl-Z does. To continue it, type fg in its terminal."
    return ""


def stopped_programs(domain: str) -> list[tuple[str, int]]:
    """Return the name and the process id of each stopped program of this user in the ROS domain."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if folder.stat().st_uid != os.getuid():
                continue
            if (folder / "stat").read_bytes().rpartition(b")")[2].split()[0] != b"T":
                continue
            words = (folder / "cmdline").read_bytes().split(b"\0")
            settings = (folder / "environ").read_bytes().split(b"\0")
        except OSError:  # the process has exited
            continue
        name = _name(words)
        if name and _domain(settings) == domain:
            found.append((name, int(folder.name)))
    return found


def _name(words: list[bytes]) -> str:
    """Return the name of the executable that a command line runs, or "" if this is not a program of ROS 2."""
    python = b"python" in words[0].rpartition(b"/")[2]
    if python and _OUR_TURTLESIM in words:
        return "turtlesim_node"
    program = _EXECUTABLE.search(words[1] if python and len(words) > 1 else words[0])
    return program["name"].decode() if program else ""


def _domain(settings: list[bytes]) -> str:
    name = b"ROS_DOMAIN_ID="
    return next((each[len(name) :].decode(errors="replace") for each in settings if each.startswith(name)), "") or "0"
