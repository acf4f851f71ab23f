"""Explain why the start of a trajectory is missing: commands may be lost before the simulator is connected."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.cause import Cause

if TYPE_CHECKING:
    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence

WAITS_FOR_SUBSCRIBER = ("get_subscription_count", "count_subscribers")


def too_soon(finding: Finding, evidence: Evidence) -> Finding:
    """Return a finding about a missing part of a trajectory, with the cause `too-soon` if commands may have been lost.

    In simulated time, the clock starts only when the publisher and the subscription are connected, so no command is
    lost. If the node itself checks how many subscriptions are connected, no command is lost in wall time either.
    """
    if evidence.recording.clock != "wall" or any(evidence.code.calls(name) for name in WAITS_FOR_SUBSCRIBER):
        return finding
    text = (
        "Commands that are published before the simulator is connected are lost. The first commands may be among them. "
        "Do not publish while get_subscription_count() returns 0."
    )
    return finding.because(Cause("too-soon", text, evidence.place("publish")))
