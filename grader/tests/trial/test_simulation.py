from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.tests.in_ros import InRos


def test_all_that_has_come_is_handled_at_once_and_what_is_said_about_it_too(in_ros: InRos) -> None:
    handled = in_ros.run("trial.scenarios:what_one_spin_handles").result
    assert handled["commands"] == 3
    assert handled["log"][-1].startswith("Spawning turtle [turtle2]")
    assert handled["after"] == 0


def test_who_has_a_client_may_ask_and_nobody_else(in_ros: InRos) -> None:
    assert in_ros.run("trial.scenarios:who_may_request").result is False
