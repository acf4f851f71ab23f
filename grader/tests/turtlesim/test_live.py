"""A turtlesim in wall time: its frames and its pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.turtlesim.turtle import FRAME_S

if TYPE_CHECKING:
    from grader.tests.in_ros import InRos


@pytest.mark.parametrize(("clears", "expected"), [(False, 1), (True, 2)])
def test_a_cleared_trail_is_shown_even_if_no_turtle_moves(in_ros: InRos, *, clears: bool, expected: int) -> None:
    found = in_ros.run("turtlesim.live_scenarios:pictures_of_a_turtle_that_stands_still", clears)
    assert found.result == expected


def test_a_late_frame_is_caught_up_and_none_left_out(in_ros: InRos) -> None:
    times, computed = zip(*in_ros.run("turtlesim.live_scenarios:late_frames").result, strict=True)
    planned = [frame * FRAME_S for frame in range(30)]
    assert times == pytest.approx(planned)
    # The frames 5 to 13 are computed as soon as frame 4 has ended.
    assert computed == pytest.approx([*planned[:5], *[planned[14]] * 9, *planned[14:]])
