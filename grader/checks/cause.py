"""Cause: why a check failed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis
    from grader.submission.where import Where


@dataclass(frozen=True)
class Cause:
    """A diagnosis id, the cause in words (empty if the observation says enough), and the place to look at."""

    diagnosis: Diagnosis
    text: str = ""
    where: Where | None = None

    def at(self, where: Where | None) -> Cause:
        """Return the cause with this place to look at, unless it names a better one itself."""
        return self if self.where is not None else replace(self, where=where)
