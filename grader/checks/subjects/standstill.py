"""Check how a drive ends: the turtle stands still because of a command, not because the commands ended."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.outcome import Finding, failed
from grader.checks.subjects.path import LIVES_S
from grader.common.lazy import np
from grader.evidence import activity

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

REST_S = 0.5
"""The turtle must stand still for at least this time (s) at the end."""
STILL = 1e-3
"""A turtle with a lower speed (m/s or rad/s) is considered to stand still."""
ZEROS = "Publish a command with all values 0, and keep publishing it or stop the timer."


def no_standstill(evidence: Evidence, expected: str) -> Finding | None:
    """Return a failed finding if the turtle moves at the end, or if no command of the node stopped it, else None."""
    where = evidence.place("publish")
    frames = evidence.recording.frames
    until = activity.end_s(evidence.recording)
    late = (frames.t_s >= until - REST_S) & (frames.t_s < until)
    linear, angular = (float(np.abs(speed[late]).max(initial=0.0)) for speed in (frames.linear, frames.angular))
    if max(linear, angular) > STILL:
        what = f"drives at {linear:.2f} m/s" if linear > STILL else f"turns at {angular:.2f} rad/s"
        cause = f"Small speeds are not 0. {ZEROS}" if max(linear, angular) < 0.1 else ZEROS
        observed = f"The turtle still {what} at the end of the {evidence.recording.duration_s:g} s of the trial."
        return failed(observed, expected, Cause("still-moving", cause, where))
    if silent_while_moving(evidence):
        observed = "The last command has values other than 0. The turtle stopped only because no more commands arrived."
        return failed(observed, expected, Cause("still-moving", ZEROS, where))
    return None


def silent_while_moving(evidence: Evidence) -> bool:
    """Return whether the last command moves the turtle, and arrives at least one second before the end of the trial."""
    last = evidence.commands[-1] if evidence.commands else None
    if last is None or max(abs(last.linear[0]), abs(last.angular[2])) <= STILL:
        return False
    return activity.end_s(evidence.recording) - last.t_s >= LIVES_S
