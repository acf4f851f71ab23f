from __future__ import annotations

import os
import signal
from typing import TYPE_CHECKING

import pytest

from grader.ros import installation, underlay
from grader.tests.domains import default_domain
from grader.tests.gradings import gradings_of
from grader.tests.in_ros import InRos

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from grader.tests.gradings import Gradings

# Started in the background of a script or by nohup, tests have signals ignored, and all that they start would too.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

# Not the domain of the user's programs, nor that of another test process.
os.environ["ROS_DOMAIN_ID"] = str(default_domain())
# Nothing that a test did not ask for stays behind it.
os.environ["GRADER_ROS2_DAEMON"] = "0"

collect_ignore = ["cases", "mistakes", "unusual", "hostile"]
"""Submissions, some of which bring tests of their own."""


@pytest.fixture(scope="session")
def in_ros(tmp_path_factory: pytest.TempPathFactory) -> InRos:
    """Processes with ROS 2 and turtlesim's interfaces, which are built if they were not yet."""
    home: Path = tmp_path_factory.mktemp("ros")
    return InRos(underlay.with_turtlesim(installation.find_ros()), home)


@pytest.fixture(scope="module")
def gradings(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Gradings]:
    """All cases that this module's tests mark with `clocks`, graded side by side."""
    yield from gradings_of(request, tmp_path_factory)
