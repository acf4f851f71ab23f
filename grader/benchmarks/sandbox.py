"""Measure how much longer a grading takes in the sandbox, relative to F (see grader.benchmarks.check).

    python -m grader.benchmarks.sandbox [--times N] [--submission FOLDER]

The same submission is graded with and without sandbox cells, in one run on the same machine. The measurements
alternate, so that other programs slow down all of them alike.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
from pathlib import Path

from grader.benchmarks.bare import bare_costs
from grader.benchmarks.measure import Cost, cost
from grader.common.interpreter import interpreter
from grader.errors import MachineError
from grader.sandbox import bubblewrap

_ROOT = Path(__file__).resolve().parents[2]
_EXERCISE = "03-circle-publisher"
_MOST = 0.5
"""The limit for the cost of the sandbox (F)."""
# Each grading runs in a separate process, like a check.
_GRADE = """
import sys
from grader.checks.exercises import find_exercise
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.submission.package import open_submission
options = Options(sys.argv[3] == "cell", "simulated")
report = grade(find_exercise(sys.argv[1]), open_submission(sys.argv[2]), options).report
sys.exit(report.exit_code)
"""


def main() -> None:
    """Measure everything and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--times", type=int, default=5, help="number of measurements, whose median is printed")
    parser.add_argument("--submission", type=Path, default=_ROOT / "solutions" / _EXERCISE)
    arguments = parser.parse_args()
    bubblewrap.require()
    costs: dict[str, list[Cost]] = {}
    for _ in range(arguments.times):
        with tempfile.TemporaryDirectory() as folder:
            measured = dict(bare_costs(arguments.submission, Path(folder)))
        for how in ("cell", "bare"):
            command = interpreter("-c", _GRADE, _EXERCISE, str(arguments.submission), how).argv
            measured[f"graded, {'confined' if how == 'cell' else 'not confined'}"] = cost(command)
        for name, one in measured.items():
            costs.setdefault(name, []).append(one)
    wall = {name: statistics.median(one.wall_s for one in of) for name, of in costs.items()}
    cpu = {name: statistics.median(one.cpu_s for one in of) for name, of in costs.items()}
    f_s = wall["colcon build"] + wall["rclpy node"]
    print(f"F = {f_s:.2f} s wall (medians of {arguments.times})\n")
    for name, seconds in wall.items():
        print(f"{name:24}{seconds:8.2f} s{seconds / f_s:8.2f} F{cpu[name]:8.2f} s CPU")
    difference = wall["graded, confined"] - wall["graded, not confined"]
    print(f"\nconfinement: {difference:+.2f} s, {difference / f_s:+.2f} F (at most {_MOST} F)")
    if difference > _MOST * f_s:
        raise MachineError("The sandbox costs more than the limit. Repeat the benchmark on an idle machine.")  # noqa: EM101


if __name__ == "__main__":
    main()
