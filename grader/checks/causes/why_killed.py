"""Explain why a target was removed although nobody caught it: the node calls /kill or /reset on its own."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.words import shorten

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.where import Where
    from grader.trial.observed import Track

KILL, RESET = "/kill", "/reset"
SAME_TIME_S = 0.1
"""The maximum difference between the recorded times of two simultaneous events (s)."""
LONGEST_S = 1.0
"""The maximum time (s) from a call to the removal that it causes."""


def why_killed(evidence: Evidence, track: Track, service: str) -> Cause:
    """Return the cause for a target that was removed before `service`, which catches targets, was called for it."""
    name = shorten(track.turtle)
    text = f"Remove a target only in the callback of {service}."
    gone_s = track.gone_s or 0.0
    for call in evidence.recording.calls:
        if call.by_trial or not -SAME_TIME_S <= gone_s - call.t_s <= LONGEST_S:
            continue
        if call.service == KILL and call.request.get("name") == track.turtle:
            text = (
                f"{KILL} was called for {name}, but {service} had not been. Call {KILL} only in the callback of "
                f"{service}, with the name in its request."
            )
        elif call.service == RESET:
            text = f"{RESET} was called, which removes all turtles except turtle1."
    return Cause("killed-uncaught", text, _place(evidence))


def _place(evidence: Evidence) -> Where | None:
    """Return the place where the node creates a request to /kill, or else where it uses a client, or None."""
    for call in evidence.code.calls("Request"):
        if isinstance(call.node.func, ast.Attribute) and ast.unparse(call.node.func.value) == "Kill":
            return call.where
    return evidence.place("call_async", "create_client")
