"""The benchmark of mistakes: F includes one node for each trial of an exercise."""

from __future__ import annotations

import importlib

import pytest

from grader.checks.exercises import find_exercise


@pytest.mark.parametrize(("step", "nodes"), [("03-circle-publisher", 1), ("04-package-files", 2), ("07-challenges", 4)])
def test_f_has_one_node_for_each_trial(step: str, nodes: int) -> None:
    benchmark = importlib.import_module("grader.benchmarks.mistakes")  # the benchmark itself imports the tests' cases
    assert benchmark.f_s(find_exercise(step), {"colcon build": 100.0, "rclpy node": 1.0}) == 100.0 + nodes


def test_each_own_target_is_that_of_an_exercise() -> None:
    benchmark = importlib.import_module("grader.benchmarks.mistakes")
    assert [find_exercise(step).id for step in benchmark.MOST_F_OF] == list(benchmark.MOST_F_OF)
