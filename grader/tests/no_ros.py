"""Grade without ROS 2, in tests with invented builds and trials."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from grader.grading import grade
from grader.ros import underlay
from grader.ros.installation import Ros

if TYPE_CHECKING:
    import pytest

NO_ROS = Ros("wheels", "0", Path("/"), (), Path("python3"), (), ())


def hide_ros(cache: Path) -> None:
    """Hide ROS 2, as `without_ros` does, until this process ends."""
    os.environ["XDG_CACHE_HOME"] = str(cache)
    vars(grade)["find_ros"] = lambda: NO_ROS
    vars(underlay)["ensure"] = lambda *_: None


def without_ros(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Do not search for a ROS 2, and do not wait for other graders on this machine."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache))
    monkeypatch.setattr(grade, "find_ros", lambda: NO_ROS)
    monkeypatch.setattr(underlay, "ensure", lambda *_: None)
