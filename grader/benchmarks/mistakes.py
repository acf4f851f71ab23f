"""Measure how long the grader takes to find mistakes in files, and how long a check of each case takes.

    python -m grader.benchmarks.mistakes [--only NNN ...]

F is the cost of similar work without the grader: a colcon build of the solution of step 03, and one process with one
rclpy node for each trial of the exercise (benchmarks/bare.py). For example, 04-package-files has two trials, and
07-challenges has four. Each part of F is the median of three measurements. The speed of a machine varies during the
minutes that this benchmark takes, so F is measured again after every few cases. Cases that need wall time are left out.
A case that exceeds the target in the first measurement is measured three more times, each time immediately after F. The
median of these three measurements is used.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from grader.benchmarks.bare import bare_costs
from grader.benchmarks.measure import cost, median
from grader.checks.exercises import find_exercise
from grader.checks.judge import judge_early
from grader.evidence.evidence import Evidence
from grader.submission.package import open_answers, open_submission
from grader.tests.case import ROOT, Case, make_submission, read_cases
from grader.tests.catalogue import MISTAKES
from grader.tests.gradings import GRADER, grade

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from grader.exercise.model import Exercise

SOLUTION = ROOT / "solutions/03-circle-publisher"
MOST_STATIC_S = 0.4
MOST_F = 2.5
MOST_F_OF = {"13-catch-them-all": 4.0}
"""The targets of the exercises whose target is not MOST_F."""
CASES_A_PIECE = 10


def main() -> None:
    """Measure everything and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--only", nargs="*", default=[], help="numbers of the cases to measure (default: all)")
    arguments = parser.parse_args()
    cases = [case for case in read_cases(MISTAKES) if case.result != "usage"]
    cases = [case for case in cases if not arguments.only or case.name.startswith(tuple(arguments.only))]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        start_s = median(lambda: cost([str(GRADER), "check", "--help"]), 5).wall_s
        static = {case.name: _static_s(case, folder / "static" / case.name) for case in cases}
        ratios: dict[str, float] = {}
        for first in range(0, len(cases), CASES_A_PIECE):
            ratios |= _ratios(cases[first : first + CASES_A_PIECE], folder / f"whole{first}")
    slowest = max(static, key=lambda name: static[name])
    print(f"static findings: at most {static[slowest]:.3f} s ({slowest}), start of the command {start_s:.2f} s")
    print(f"  together {static[slowest] + start_s:.2f} s; target {MOST_STATIC_S:g} s")
    for exercise in sorted({_exercise(case).id for case in cases}):
        names = [case.name for case in cases if _exercise(case).id == exercise]
        of_it = {name: ratios[name] for name in names if name in ratios}
        if of_it:
            longest = max(of_it, key=lambda name: of_it[name])
            print(f"{exercise}: {len(of_it)} in simulated time, the slowest {of_it[longest]:.2f} F ({longest})")
    over = [case.name for case in cases if ratios.get(case.name, 0.0) > _most_f(case)]
    print(f"over the target: {', '.join(over) or 'none'}")


def _ratios(cases: Sequence[Case], folder: Path) -> dict[str, float]:
    """Return the cost of checking each case, divided by F. Cases that need wall time are left out."""
    bare = _bare_s(folder / "bare")
    found: dict[str, float] = {}
    for case in cases:
        seconds = _whole_s(case, folder / case.name)
        if seconds is None:
            continue
        found[case.name] = seconds / f_s(_exercise(case), bare)
        if found[case.name] > _most_f(case):
            found[case.name] = statistics.median(_beside_f(case, folder / f"{case.name}-{turn}") for turn in range(3))
        print(f"{case.name}: {seconds:.2f} s, {found[case.name]:.2f} F", flush=True)
    return found


def _beside_f(case: Case, folder: Path) -> float:
    """Return the time of a check divided by F, or infinity if the check needed wall time.

    F is measured immediately before the check.
    """
    bare = _bare_s(folder / "bare")
    seconds = _whole_s(case, folder / "whole")
    return math.inf if seconds is None else seconds / f_s(_exercise(case), bare)


def _bare_s(folder: Path) -> dict[str, float]:
    """Return the median duration of each part of F (s), because single measurements vary too much."""
    costs = [bare_costs(SOLUTION, folder / str(turn)) for turn in range(3)]
    return {part: statistics.median(each[part].wall_s for each in costs) for part in costs[0]}


def f_s(exercise: Exercise, bare: Mapping[str, float]) -> float:
    """Return F for this exercise (s). `bare` has the duration of a colcon build and of one rclpy node (s)."""
    return bare["colcon build"] + len(exercise.trials) * bare["rclpy node"]


def _exercise(case: Case) -> Exercise:
    return find_exercise(case.exercise or case.base)


def _most_f(case: Case) -> float:
    """Return the target for a whole check of the case (F)."""
    return MOST_F_OF.get(_exercise(case).id, MOST_F)


def _static_s(case: Case, folder: Path) -> float:
    """Return the time for opening the submission and judging its files (s)."""
    given = make_submission(case, folder)
    exercise = _exercise(case)
    begun = time.monotonic()
    submission = open_submission(given) if exercise.package else open_answers(given)
    judge_early(Evidence(exercise, submission))
    return time.monotonic() - begun


def _whole_s(case: Case, folder: Path) -> float | None:
    """Return the duration of a whole check (s), or None if the check needed wall time."""
    begun = time.monotonic()
    graded = grade(case, "auto", folder)
    seconds = time.monotonic() - begun
    assert graded.report is not None, json.dumps(graded.stderr)
    clock = graded.report["clock"]
    return None if clock["used"] == "wall" or " in wall time: " in clock["why"] else seconds


if __name__ == "__main__":
    main()
