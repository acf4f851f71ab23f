from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from grader.tests.both_worlds import of_our_ros2

if TYPE_CHECKING:
    import pytest

COMPARED = {"test_golden.py"}
"""The modules whose tests also apply to the real `ros2`. All other modules test only our `ros2`: its messages, speed,
start and exit."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Skip the tests of our own `ros2` if the tests use the real `ros2`."""
    for item in items:
        if item.path.parent == Path(__file__).parent and item.path.name not in COMPARED:
            item.add_marker(of_our_ros2)
