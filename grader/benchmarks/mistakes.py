"""What a mistake costs: how soon the files alone tell it, and how long the slowest one in simulated time takes, in F.

    python -m grader.benchmarks.mistakes [--only NNN ...]

F is a bare colcon build of the package and a bare process with one rclpy node (benchmarks/check.py).
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from pathlib import Path

from grader.benchmarks.bare import bare_costs
from grader.benchmarks.measure import cost
from grader.checks.evidence import Evidence
from grader.checks.judge import judge_early
from grader.exercise import find_exercise
from grader.submission import open_answers, open_submission
from grader.tests.case import ROOT, Case, make_submission, read_cases
from grader.tests.catalogue import MISTAKES
from grader.tests.grading import GRADER, grade

MOST_STATIC_S = 0.4
MOST_F = 2.0


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--only", nargs="*", default=[], help="numbers of cases; all when left out")
    asked = parser.parse_args()
    cases = [case for case in read_cases(MISTAKES) if case.result != "usage"]
    cases = [case for case in cases if not asked.only or case.name.startswith(tuple(asked.only))]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bare = bare_costs(ROOT / "solutions/03-circle-publisher", folder)
        f_s = bare["colcon build"].wall_s + bare["rclpy node"].wall_s
        start_s = cost([str(GRADER), "check", "--help"]).wall_s
        static = {case.name: _static_s(case, folder / "static" / case.name) for case in cases}
        whole = {case.name: _whole_s(case, folder / "whole" / case.name) for case in cases}
    slowest = max(static, key=lambda name: static[name])
    print(f"F = {f_s:.2f} s")
    print(f"static findings: at most {static[slowest]:.3f} s ({slowest}), start of the command {start_s:.2f} s")
    print(f"  together {static[slowest] + start_s:.2f} s; aim {MOST_STATIC_S:g} s")
    simulated = {name: seconds for name, seconds in whole.items() if seconds is not None}
    if simulated:
        longest = max(simulated, key=lambda name: simulated[name])
        print(f"slowest in simulated time: {simulated[longest] / f_s:.2f} F ({longest}); aim {MOST_F:g} F")
        over = [name for name, seconds in simulated.items() if seconds > MOST_F * f_s]
        print(f"  over the aim: {', '.join(over) or 'none'}")


def _static_s(case: Case, folder: Path) -> float:
    """Seconds from a folder to what its files tell."""
    given = make_submission(case, folder)
    exercise = find_exercise(case.exercise or case.base)
    begun = time.monotonic()
    submission = open_submission(given) if exercise.package else open_answers(given)
    judge_early(Evidence(exercise, submission))
    return time.monotonic() - begun


def _whole_s(case: Case, folder: Path) -> float | None:
    """Seconds of a whole check; None where wall time judged."""
    begun = time.monotonic()
    graded = grade(case, "auto", folder)
    seconds = time.monotonic() - begun
    assert graded.report is not None, json.dumps(graded.stderr)
    return None if graded.report["clock"]["used"] == "wall" else seconds


if __name__ == "__main__":
    main()
