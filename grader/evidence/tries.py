"""Try: a change in a copy of a submission, at the place that a failed check names, and the result of the change."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Result = Literal["passes", "further", "refuted"]
"""The result of testing a change: the check passes, it fails for another reason, or the cause is refuted."""


@dataclass(frozen=True)
class Try:
    """A change that was tested in a copy of the submission: the check, its diagnosis, the change, and the result.

    `difference` is a unified diff for instructors only, because the diff gives the solution away.
    """

    check: str
    diagnosis: str
    result: Result
    difference: str


@dataclass(frozen=True)
class Tries:
    """All tested changes of one submission.

    `behind` counts the causes that appeared only after other causes had been fixed.

    `stopped` is the reason why some changes could not be tested. `stopped` is empty if all changes were tested, or if
    the caller interrupted the tests.
    """

    made: tuple[Try, ...] = ()
    behind: int = 0
    stopped: str = ""

    def of(self, check: str, diagnosis: str | None) -> Try | None:
        """Return the tested change for this check with this diagnosis, or None."""
        return next((each for each in self.made if (each.check, each.diagnosis) == (check, diagnosis)), None)
