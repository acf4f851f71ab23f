"""What a mistake costs: how soon the files alone tell it, and how long the slowest one in simulated time takes, in F.

    python -m grader.benchmarks.mistakes [--only NNN ...]

F is what the same work costs bare: a colcon build of the package and a process with one rclpy node for each node that
the exercise runs (benchmarks/bare.py); 04-package-files runs two, 07-challenges four. It is measured again every few
cases, since machines change their pace within the minutes that this takes. A slow case is measured once more, and the
faster of the two counts: what is slow by itself is slow twice.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from grader.benchmarks.bare import bare_costs
from grader.benchmarks.measure import cost, median
from grader.checks.evidence import Evidence
from grader.checks.judge import judge_early
from grader.exercise import find_exercise
from grader.submission import open_answers, open_submission
from grader.tests.case import ROOT, Case, make_submission, read_cases
from grader.tests.catalogue import MISTAKES
from grader.tests.grading import GRADER, grade

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.exercise import Exercise

MOST_STATIC_S = 0.4
MOST_F = 2.0
CASES_A_PIECE = 10


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--only", nargs="*", default=[], help="numbers of cases; all when left out")
    asked = parser.parse_args()
    cases = [case for case in read_cases(MISTAKES) if case.result != "usage"]
    cases = [case for case in cases if not asked.only or case.name.startswith(tuple(asked.only))]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        start_s = median(lambda: cost([str(GRADER), "check", "--help"]), 5).wall_s
        static = {case.name: _static_s(case, folder / "static" / case.name) for case in cases}
        ratios: dict[str, float] = {}
        for first in range(0, len(cases), CASES_A_PIECE):
            ratios |= _ratios(cases[first : first + CASES_A_PIECE], folder / f"whole{first}")
    slowest = max(static, key=lambda name: static[name])
    print(f"static findings: at most {static[slowest]:.3f} s ({slowest}), start of the command {start_s:.2f} s")
    print(f"  together {static[slowest] + start_s:.2f} s; aim {MOST_STATIC_S:g} s")
    for exercise in sorted({_exercise(case).id for case in cases}):
        names = [case.name for case in cases if _exercise(case).id == exercise]
        of_it = {name: ratios[name] for name in names if name in ratios}
        if of_it:
            longest = max(of_it, key=lambda name: of_it[name])
            print(f"{exercise}: {len(of_it)} in simulated time, the slowest {of_it[longest]:.2f} F ({longest})")
    over = [name for name, ratio in ratios.items() if ratio > MOST_F]
    print(f"over the aim of {MOST_F:g} F: {', '.join(over) or 'none'}")


def _ratios(cases: Sequence[Case], folder: Path) -> dict[str, float]:
    """What the checks of some cases cost in F, without those that wall time judged."""
    bare = bare_costs(ROOT / "solutions/03-circle-publisher", folder / "bare")
    found: dict[str, float] = {}
    for case in cases:
        nodes = 1 + len(_exercise(case).trials)
        f_s = bare["colcon build"].wall_s + nodes * bare["rclpy node"].wall_s
        seconds = _whole_s(case, folder / case.name)
        if seconds is not None and seconds > MOST_F * f_s:
            again_s = _whole_s(case, folder / f"{case.name}-again")
            seconds = seconds if again_s is None else min(seconds, again_s)
        if seconds is not None:
            found[case.name] = seconds / f_s
            print(f"{case.name}: {seconds:.2f} s, F = {f_s:.2f} s, {found[case.name]:.2f} F", flush=True)
    return found


def _exercise(case: Case) -> Exercise:
    return find_exercise(case.exercise or case.base)


def _static_s(case: Case, folder: Path) -> float:
    """Seconds from a folder to what its files tell."""
    given = make_submission(case, folder)
    exercise = _exercise(case)
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
