"""The evidence that students may see."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


def evidence_for_students(evidence: Evidence) -> Evidence:
    """Return the evidence without hidden checks, and without the runs that only hidden checks use.

    The run of the first trial always stays.
    """
    exercise = evidence.exercise
    shown = tuple(spec for spec in exercise.checks if not spec.hidden)
    trials = {exercise.trials[0].id, *(spec.trial for spec in shown)}
    runs = {trial: run for trial, run in evidence.runs.items() if trial in trials}
    return replace(evidence, exercise=replace(exercise, checks=shown), runs=runs)
