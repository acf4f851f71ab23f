"""The table of `python -m grader.benchmarks.all`, printed by a separate process, since benchmarks import the tests."""

from __future__ import annotations

import subprocess

from grader.common.interpreter import interpreter

GIVEN_COSTS = """
import sys
from grader.benchmarks import all as whole, notebooks
from grader.benchmarks.grade import ClassCost
from grader.benchmarks.measure import Cost
whole.bare_costs = lambda *_: {"colcon build": Cost(1.0, 1.5, 1.0), "rclpy node": Cost(1.0, 1.0, 1.0)}
whole.cost = lambda _: Cost(3.0, 5.0, 100.0)
whole.seconds_to_verdict = lambda *_: 0.8
whole.page_cost = lambda *_: (0.2, 70.0)
whole.class_cost = lambda *_: ClassCost(4, 1.0, 1.8, 300.0)
notebooks.sync_s = lambda *_: 6.0
sys.argv = ["all", "--times", "2", "--class", "4", "--sync", "3"]
whole.main()
"""


def test_each_figure_stands_beside_its_aim() -> None:
    start = interpreter("-c", GIVEN_COSTS)
    done = subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert "load" in lines[0]
    assert lines[1] == "F = 2.00 s wall, 2.50 s CPU (medians of 15)"
    assert {line[:44].strip(): line[44:].split() for line in lines[4:]} == {
        "grader check 03, wall time": ["1.50", "1.15", "F"],
        "grader check 03, CPU time": ["2.50", "1.20", "F"],
        "grader check 03 again, wall time": ["1.50", "1.15", "F"],
        "grader check 03 again, CPU time": ["2.50", "1.20", "F"],
        "grader check 07, wall time": ["1.50", "2.00", "F"],
        "grader check 07, CPU time": ["2.50", "F"],
        "grader check 07 again, wall time": ["1.50", "2.00", "F"],
        "grader check 07 again, CPU time": ["2.50", "F"],
        "grader watch, from save to verdict": ["0.40", "0.35", "F"],
        "the page of a report": ["0.10", "0.15", "F"],
        "the page of a report, size": ["70.00", "250.00", "KB"],
        "grader --help": ["3.00", "0.10", "s"],
        "grader status": ["3.00", "0.10", "s"],
        "grader hint 03": ["3.00", "0.10", "s"],
        "a class of 4, wall time each": ["0.50", "0.55", "F"],
        "a class of 4, CPU time each": ["0.90", "F"],
        "a class of 4, total memory": ["300.00", "400.00", "MB"],
        "gradebook sync of 3, wall time each": ["1.00", "0.55", "F"],
    }
