from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader import ros, underlay
from grader.tests.in_ros import InRos

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(scope="session")
def in_ros(tmp_path_factory: pytest.TempPathFactory) -> InRos:
    """Processes with ROS 2 and turtlesim's interfaces, which are built if they were not yet."""
    here = ros.find_ros()
    home: Path = tmp_path_factory.mktemp("ros")
    return InRos(here, underlay.ensure(here), home)
