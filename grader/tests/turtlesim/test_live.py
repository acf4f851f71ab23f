"""The pictures of a turtlesim in wall time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from grader.tests.in_ros import InRos


@pytest.mark.parametrize(("clears", "expected"), [(False, 1), (True, 2)])
def test_a_cleared_trail_is_shown_even_if_no_turtle_moves(in_ros: InRos, *, clears: bool, expected: int) -> None:
    found = in_ros.run("turtlesim.live_scenarios:pictures_of_a_turtle_that_stands_still", clears)
    assert found.result == expected
