"""`grader gradebook compare`: the scores on which a kernel and the grader disagree, and the unconfirmed scores."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.classroom.results import Results
from grader.gradebook.confirmed import submissions_of, unconfirmed
from grader.gradebook.kernel_scores import kernel_scores

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.gradebook.class_folders import ClassFolders


@dataclass(frozen=True)
class Difference:
    """A check on which the kernel and the grader disagree, or whose score is not confirmed.

    `kernel` is None if the notebook has no score for the check. `grader` is None if the grader has not confirmed the
    score. If `grader` is None, the student gets 0 points for the check, and `why` is the reason.
    """

    student: str
    step: str
    check: str
    kernel: float | None
    grader: float | None
    why: str = ""


@dataclass(frozen=True)
class Comparison:
    """The differences, the steps that were compared, and the steps for which the grader has no result yet."""

    differences: tuple[Difference, ...]
    synced: tuple[str, ...]
    not_synced: tuple[str, ...]


def compare(folders: ClassFolders, steps: Sequence[str]) -> Comparison:
    """Return checks on which autograde's kernel and the grader disagree, and scores that are not confirmed."""
    kept = Results(folders.results)
    wanted = [find_exercise(step).id for step in steps]
    differences: list[Difference] = []
    with folders.gradebook() as gradebook:
        doubted = unconfirmed(gradebook, kept, wanted)
        results = {(student, step): kept.load(student, step) for student, step, _ in submissions_of(gradebook, wanted)}
    synced = dict.fromkeys(step for (_, step), result in results.items() if result)
    doubts = {(each.student, each.step, check): each.why for each in doubted for check in each.checks}
    for (student, step), result in results.items():
        if step not in synced:
            continue
        by_kernel = kernel_scores(folders.autograded(student, step)) or {}
        points = {outcome.id: outcome.points for outcome in result.report.outcomes} if result else {}
        for check in dict.fromkeys([*points, *by_kernel, *(name for *of, name in doubts if of == [student, step])]):
            why = doubts.get((student, step, check), "")
            if why:
                differences.append(Difference(student, step, check, by_kernel.get(check), None, why))
            elif check in by_kernel and check in points and by_kernel[check] != points[check]:
                differences.append(Difference(student, step, check, by_kernel[check], points[check]))
    not_synced = dict.fromkeys(step for _, step in results if step not in synced)
    return Comparison(tuple(differences), tuple(synced), tuple(not_synced))
