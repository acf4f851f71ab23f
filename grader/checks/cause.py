"""Why a check failed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis
    from grader.checks.edit import Edit
    from grader.submission.where import Where


@dataclass(frozen=True)
class Cause:
    """The cause of a failed check: the id of the diagnosis, a text that explains the cause, and the place in the code.

    The text is empty if the observation needs no explanation, or if no explanation is known. `fix` is the smallest
    change that would fix the mistake, if known. In simulated time, the grader can test this change in a copy of the
    submission. Students see the change only if exercise.toml sets `show_fix`.
    """

    diagnosis: Diagnosis
    text: str = ""
    where: Where | None = None
    fix: tuple[Edit, ...] = ()

    def at(self, where: Where | None) -> Cause:
        """Return the cause with this place in the code. A cause that already has a place is returned unchanged."""
        return self if self.where is not None else replace(self, where=where)

    def fixed_by(self, edits: tuple[Edit, ...]) -> Cause:
        """Return the cause with the change that would fix the mistake."""
        return replace(self, fix=edits)
