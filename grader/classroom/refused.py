"""Why a submission cannot be graded: a text for the student, and the diagnosis under which the class page counts it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis


@dataclass(frozen=True)
class Refused:
    """The reason why a submission cannot be graded, as a text for the student.

    `diagnosis` is None if the machine failed while reading the submission. Even then, other submissions are graded.
    """

    reason: str
    diagnosis: Diagnosis | None

    @property
    def of_the_machine(self) -> bool:
        """Whether the machine failed, which is not the student's fault."""
        return self.diagnosis is None
