"""Why commands or log lines stop before the end: a timer is cancelled."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.where import Where

CANCELS = "cancel stops the timer, so it does not call its method again."


def cancelled(evidence: Evidence) -> Where | None:
    """Return the place where the node cancels a timer, or None."""
    if evidence.code.calls("create_timer") and evidence.code.calls("cancel"):
        return evidence.place("cancel")
    return None
