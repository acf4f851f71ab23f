"""Made-up results of the functions and programs of step 11, and the solution's package with other files."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.checks.kinds import KINDS
from grader.evidence.evidence import Evidence, Run
from grader.submission.package import open_submission
from grader.tests.case import ROOT
from grader.trial.called import Called

if TYPE_CHECKING:
    from grader.checks.outcome import Finding
    from grader.submission.package import Submission

EXERCISE = find_exercise("11-bags")
SPECS = {spec.id: spec for spec in EXERCISE.checks}
X, Y, RADIUS = 5.5, 7.25, 1.75
"""The circle from which the points of the call "whole" are drawn."""
IMPORT = 'Traceback (most recent call last):\n  File "my_robot_controller/circle_fit.py", line 3, in <module>\n'
"""The beginning of the traceback of an exception that the import of the module raises."""


@cache
def solution() -> Submission:
    return open_submission(ROOT / "solutions/11-bags")


def judged(
    check: str,
    called: Called | None = None,
    files: dict[str, bytes] | None = None,
    others: tuple[Called, ...] = (),
    *,
    has_bag: bool = True,
) -> Finding:
    """Return the finding of one check on the results of these calls, or on the solution with these files added.

    The files of a bag replace the bag of the solution. If `has_bag` is False, the bag is left out.
    """
    spec = SPECS[check]
    files = files or {}
    bag = not has_bag or any(path.startswith("circle_bag/") for path in files)
    kept = {path: data for path, data in solution().files.items() if not (bag and path.startswith("circle_bag/"))}
    submission = replace(solution(), files={**kept, **files})
    runs = {spec.trial: Run(called=(*others, called))} if called is not None else {}
    evidence = Evidence(EXERCISE, submission, runs=runs).from_trial(spec.trial)
    return KINDS[spec.kind].judge(evidence, spec.params)


def returned(*values: float, kind: str = "tuple") -> Called:
    return Called("whole", "exit 0", values=values, kind=kind)


def raised(id_: str, error: str, classes: str = "") -> Called:
    lines = ("Traceback (most recent call last):", '  File "my_robot_controller/circle_fit.py", line 9, in f', error)
    return Called(id_, "exit 1", stderr="\n".join(lines), kind=classes)


def printed(line: str, id_: str = "slow") -> Called:
    return Called(id_, "exit 0", stdout=f"{line}\n")
