"""Commands that were lost because nobody listened yet: the way lacks its beginning, and the rest of it is right."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence

ASKS = ("get_subscription_count", "count_subscribers")


def too_soon(finding: Finding, evidence: Evidence) -> Finding:
    """The finding about a way of which only the beginning is short, with its cause where that is known.

    In simulated time the clock starts when the two sides have found each other, so nothing is lost; nor is it for a
    node that asks who listens.
    """
    if evidence.recording.clock != "wall" or any(evidence.code.calls(name) for name in ASKS):
        return finding
    cause = (
        "All that follows is right: the first commands were sent before the simulator had found the publisher, and "
        "got lost. Send none as long as get_subscription_count() says 0."
    )
    return replace(finding, diagnosis="too-soon", cause=cause, where=evidence.place("publish"))
