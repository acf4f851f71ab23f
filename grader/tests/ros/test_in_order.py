"""Commands reach the turtle in the order in which they were given, even if the machine is too busy for each at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from grader.tests.in_ros import InRos


@pytest.mark.parametrize(
    ("name", "order"),
    [("begun", [0, 1, 2, 3, 4, 5]), ("driven", [1.0, 2.0, 0.0]), ("typed", [0.0, 1.57, None])],
)
def test_calls_begin_in_the_order_of_the_requests(in_ros: InRos, name: str, order: list[object]) -> None:
    assert in_ros.run(f"ros.calls_in_order:{name}").result == order
