"""Helpers for the tests of the bench: settings with few nodes, the files of the solution, and runs."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.exercise.own_numbers import draw_numbers
from grader.ros import underlay
from grader.ros.installation import find_ros
from grader.submission.package import open_submission
from grader.testbench.bench import Bench
from grader.testbench.result import Ended, NodeRun, runs_of
from grader.tests.case import Case, make_submission

if TYPE_CHECKING:
    from pathlib import Path

    from grader.exercise.node_under_test import TestsSpec

STEP = "12-tests"
TESTS = "test/test_wall_guard.py"


def spec(*broken: str, right_runs: int = 1, duration_s: float = 20.0) -> TestsSpec:
    """Return the settings of the course's tests with the solution's numbers, but with only these broken nodes."""
    exercise = find_exercise(STEP)
    whole = exercise.trials[0].tests
    assert whole is not None
    assert exercise.numbers is not None
    whole = whole.with_numbers(draw_numbers(exercise.numbers, "example").values)
    chosen = tuple(each for each in whole.broken if each.id in broken)
    return dataclasses.replace(whole, broken=chosen, right_runs=right_runs, duration_s=duration_s)


def solution_files(folder: Path) -> dict[str, bytes]:
    """Return the files of the solution, which is written below the folder."""
    case = Case(name="solution", why="", result="passed", base=STEP)
    return dict(open_submission(make_submission(case, folder / "in")).files)


def run(nodes: TestsSpec, files: dict[str, bytes], *, lanes: int = 1, in_cell: bool = True) -> tuple[NodeRun, ...]:
    """Run the tests in these files on these nodes."""
    return runs_of(all_ended(nodes, files, lanes=lanes, in_cell=in_cell))


def all_ended(nodes: TestsSpec, files: dict[str, bytes], *, lanes: int = 1, in_cell: bool = True) -> tuple[Ended, ...]:
    """Run the tests in these files on these nodes, and return what the bench knows of each run."""
    ros = underlay.with_turtlesim(find_ros())
    bench = Bench(nodes, "wall_guard", "my_robot_controller", files, ros, in_cell=in_cell, lanes=lanes)
    bench.start()
    try:
        return bench.result()
    finally:
        bench.close()
