from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.tests.in_ros import InRos


def test_one_spin_handles_all_waiting_requests_and_their_log_lines(in_ros: InRos) -> None:
    handled = in_ros.run("trial.scenarios:what_one_spin_handles").result
    assert handled["commands"] == 3
    assert handled["log"][-1].startswith("Spawning turtle [turtle2]")
    assert handled["after"] == 0


def test_only_a_client_of_an_action_may_act(in_ros: InRos) -> None:
    assert in_ros.run("trial.scenarios:who_may_act").result is False


def test_a_request_is_answered_and_recorded_without_an_executor(in_ros: InRos) -> None:
    handled = in_ros.run("trial.scenarios:a_request_without_an_executor").result
    assert handled["requests"] == 1
    assert handled["calls"] == [["/spawn", "turtle2"]]
    assert handled["log"].startswith("Spawning turtle [turtle2]")
    assert handled["name"] == "turtle2"


def test_a_call_between_two_nodes_is_recorded_and_answered_by_its_server_alone(in_ros: InRos) -> None:
    overheard = in_ros.run("trial.scenarios:a_call_between_two_nodes").result
    assert overheard == {"recorded": [["/lay", "turtlesim/srv/Spawn", "egg"]], "again": False, "name": "EGG"}


def test_a_snapshot_queries_only_the_topics_whose_endpoints_have_changed(in_ros: InRos) -> None:
    found = in_ros.run("trial.scenarios:graphs_of_two_nodes").result
    assert (found["without news"], found["queries"]) == (["/first"], 0)
    assert (found["another"], found["one less"]) == (["/first", "/second"], ["/second"])
