from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.tests.in_ros import InRos


def test_what_comes_before_the_clock_starts_has_no_time_after_it(in_ros: InRos) -> None:
    assert in_ros.run("trial.scenarios:a_line_while_the_graph_is_looked_at").result == [0.0]


def test_the_clock_starts_with_the_first_command_whatever_has_not_been_found_yet(in_ros: InRos) -> None:
    assert in_ros.run("trial.scenarios:a_node_that_drives_before_it_is_found").result == 1


def test_the_clock_waits_longer_for_a_node_that_waits_for_a_processor(in_ros: InRos) -> None:
    found = in_ros.run("trial.scenarios:who_is_found_after_the_limit").result
    assert found == {"asleep": False, "waiting": True}


def test_no_time_of_a_trial_counts_during_which_the_clock_of_the_system_was_set(in_ros: InRos) -> None:
    found = in_ros.run("trial.scenarios:periods_that_count_as_stalls").result
    assert found == {"left alone": False, "set": True, "set and set again": True}
