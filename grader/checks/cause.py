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
    """A diagnosis id, the cause in words (empty if the observation is enough), and the place in the code to look at.

    `fix` is the smallest change that would fix the mistake, if known. The grader tests this change but never shows it
    to a student.
    """

    diagnosis: Diagnosis
    text: str = ""
    where: Where | None = None
    fix: tuple[Edit, ...] = ()

    def at(self, where: Where | None) -> Cause:
        """Return the cause with this place in the code. A cause that already has a place is returned unchanged."""
        return self if self.where is not None else replace(self, where=where)

    def fixed_by(self, edits: tuple[Edit, ...]) -> Cause:
        """Return the cause with the change that would fix it."""
        return replace(self, fix=edits)
