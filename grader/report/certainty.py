"""Decide whether the cause of a failed check is a fact or only a possibility.

A cause is a fact if the files, the build, an exception or the recording show it directly, or if a test has proved it:
with the suggested fix, the check passes or the node gets further. All other causes are conclusions from the source code
or from the node's behaviour, and may be wrong. grader/checks/certain.py lists the diagnoses that are facts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from grader.checks.certain import FACTS
from grader.checks.kinds import KINDS
from grader.report.report import FURTHER, PASSES

if TYPE_CHECKING:
    from grader.checks.outcome import Outcome


def is_certain(outcome: Outcome) -> bool:
    """Return whether the cause of this failed check is a fact."""
    finding = outcome.finding
    kind = KINDS.get(outcome.kind)
    judges_files = kind is not None and kind.stage != "trial"
    return judges_files or finding.diagnosis in FACTS or finding.tried.startswith((PASSES, FURTHER))


def cause_label(outcome: Outcome) -> Literal["why", "likely"]:
    """Return the label for the cause of this failed check in a report: "why" for a fact, "likely" for a possibility."""
    return "why" if is_certain(outcome) else "likely"


def cause_sentence(outcome: Outcome) -> str:
    """Return the cause as a sentence that says "Likely cause" if the cause is not certain.

    If there is no cause, the sentence is empty.
    """
    cause = outcome.finding.cause
    return cause if is_certain(outcome) or not cause else f"Likely cause: {cause}"
