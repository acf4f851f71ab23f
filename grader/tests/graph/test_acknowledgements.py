"""A command waits until its last messages have arrived, and not only for a fixed time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.ros.installation import FASTDDS_PROFILE

if TYPE_CHECKING:
    from grader.tests.in_ros import InRos


@pytest.mark.parametrize(
    ("profile", "expected"), [("", [4, 4]), (str(FASTDDS_PROFILE), [4, 4]), ("/users/own.xml", [1, 1])]
)
def test_late_acknowledgements_are_awaited_if_they_are_requested_often(
    in_ros: InRos, profile: str, expected: list[int]
) -> None:
    assert in_ros.run("graph.acknowledgements:waits", profile).result == expected
