"""Correct packages, and the wrong packages that the operators derive from them."""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.evidence.evidence import Evidence
from grader.submission.package import open_submission
from grader.tests.case import CASES, Case, make_submission, read_cases
from grader.tests.operators import (
    package_xml,
    places,
    setup_py,
    source_calls,
    source_names,
    source_syntax,
    source_values,
)
from grader.tests.operators.operator import Package
from grader.trial.clues import wall_clues

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from grader.tests.operators.operator import Change, Operator

OPERATORS: tuple[Operator, ...] = (
    *source_names.OPERATORS,
    *source_calls.OPERATORS,
    *source_values.OPERATORS,
    *source_syntax.OPERATORS,
    *setup_py.OPERATORS,
    *package_xml.OPERATORS,
    *places.OPERATORS,
)
STEPS = ("01-first-node", "03-circle-publisher", "04-package-files", "06-pose-subscriber")
"""The solutions to change. `bases` repeats each solution, so that more than half of the packages are solutions."""
TWO_AT_ONCE = 1 / 3


@dataclass(frozen=True)
class Made:
    """A wrong package, with the correct package, the operators and the changed places."""

    name: str
    exercise: str
    right: Mapping[str, str]
    files: Mapping[str, str]
    mistakes: tuple[tuple[Operator, Change], ...]

    @property
    def operators(self) -> str:
        """Return the names of the operators."""
        return " + ".join(operator.name for operator, _ in self.mistakes)


def bases(folder: Path) -> list[tuple[str, Package]]:
    """Return the correct packages with their exercises: (exercise, package)."""
    unusual = [case for case in read_cases(CASES.parent / "unusual") if case.result == "passed"]
    found = [_read(case, folder) for case in unusual if case.exercise and not case.exercise.startswith(("02", "07"))]
    right = [each for each in found if each is not None]
    for step in STEPS:
        own = _read(Case(name=step, why="", result="passed", base=step), folder)
        assert own is not None
        right += [own] * max(1, len(right) // len(STEPS))
    return right


def _read(case: Case, folder: Path) -> tuple[str, Package] | None:
    """Return the package of a case, or None if it has no node, a node that might use wall time, or binary files."""
    submission = open_submission(make_submission(case, folder / case.name))
    exercise = find_exercise(case.exercise or case.base)
    evidence = Evidence(exercise, submission)
    source = evidence.node_file
    entry = evidence.entry_point()
    if source is None or wall_clues(submission.files, entry.partition(":")[0].strip() if entry else None):
        return None
    try:
        return exercise.id, Package({path: data.decode() for path, data in submission.files.items()}, source)
    except UnicodeDecodeError:
        return None


def make(right: Sequence[tuple[str, Package]], number: int, seed: int, operators: Sequence[Operator]) -> Made:
    """Return the wrong package with this number. The same seed gives the same package."""
    draw = random.Random(f"{seed} {number}")
    amount = 2 if draw.random() < TWO_AT_ONCE and len(operators) > 1 else 1
    while True:
        exercise, package = draw.choice(right)
        mistakes: list[tuple[Operator, Change]] = []
        for operator in draw.sample(operators, min(amount, len(operators))):
            observed = Package(mistakes[-1][1].files if mistakes else package.files, package.source)
            change = operator.make(observed, draw) if observed.source in observed.files else None
            if change is not None:
                mistakes.append((operator, change))
        if len(mistakes) == amount:
            return Made(f"{number:04}", exercise, package.files, mistakes[-1][1].files, tuple(mistakes))
