"""The words of a finding, for tests that compare a situation with a near miss.

A near miss is evidence that differs from the situation in one thing, so that the words would not be true.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.outcome import Finding


def told(finding: Finding) -> str:
    """Return what a report prints about a finding: the observation, the requirement and the cause, one per line."""
    return f"{finding.observed}\n{finding.expected}\n{finding.cause}"
