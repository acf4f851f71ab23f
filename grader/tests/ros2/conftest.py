from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from grader.tests.both_worlds import of_our_ros2

if TYPE_CHECKING:
    import pytest

COMPARED = {"test_golden.py"}
"""What the real `ros2` must do as well. All else is about ours: words that help, speed, how it starts and ends."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Skip tests of our own `ros2` where the real one is used."""
    for item in items:
        if item.path.parent == Path(__file__).parent and item.path.name not in COMPARED:
            item.add_marker(of_our_ros2)
