"""Cause: why something failed, as one diagnosis says it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.submission.where import Where


@dataclass(frozen=True)
class Cause:
    """The stable id, the cause in words, and the place to look at where that is known better than by what was seen."""

    diagnosis: str
    text: str
    where: Where | None = None
