"""Cause: why a check failed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis
    from grader.submission.where import Where


@dataclass(frozen=True)
class Cause:
    """A diagnosis id, the cause in words, and the place to look at if it is known better than from what was seen."""

    diagnosis: Diagnosis
    text: str
    where: Where | None = None
