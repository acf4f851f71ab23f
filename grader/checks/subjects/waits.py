"""Check that no callback of the node waits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.awaiting import awaits_in_group
from grader.checks.causes.callback_groups import in_default_group
from grader.checks.causes.waiting import has_threads, waits_in_callbacks
from grader.checks.kind import Kind, NoParams
from grader.checks.outcome import Finding, failed, passed
from grader.evidence import activity, student_log

if TYPE_CHECKING:
    from grader.checks.causes.waiting import Wait
    from grader.evidence.evidence import Evidence

EXPECTED = "No callback of the node waits."
SILENT_S = 2.0
"""A node is considered to hang if it does nothing for this time (s) after a response."""
ALSO_S = 0.05
"""Anything that arrives within this time (s) after a response may have been sent before the response."""


def never_waits(evidence: Evidence, _: NoParams) -> Finding:
    """No callback waits for a server or for a period of time.

    A callback may wait for a response only if another thread can receive the response.
    """
    waits = waits_in_callbacks(evidence)
    finding = _certain(evidence, waits)
    if finding is not None:
        return finding
    if waits and _hangs(evidence):
        return failed("After a response, the node did nothing more.", EXPECTED, _same_group(waits[0]))
    return passed("Other threads receive the responses for which a callback waits." if waits else EXPECTED)


def _early(evidence: Evidence, _: NoParams) -> Finding | None:
    return _certain(evidence, waits_in_callbacks(evidence))


def _certain(evidence: Evidence, waits: list[Wait]) -> Finding | None:
    """Return a failed finding if the source alone shows that a callback waits where it must not, or None."""
    threads = has_threads(evidence)
    first = next((wait for wait in waits if not (threads and wait.needs_thread)), None)
    if first is not None:
        return failed(f"A callback {first.observed}.", EXPECTED, first.cause)
    blocked = next((wait for wait in waits if in_default_group(evidence, wait)), None)
    if blocked is None and (awaits := awaits_in_group(evidence)) is not None:
        return failed("A callback awaits a response.", EXPECTED, awaits)
    if blocked is None:
        return None
    return failed(f"A callback {blocked.observed}.", EXPECTED, _same_group(blocked))


def _same_group(wait: Wait) -> Cause:
    until = "before the timeout" if wait.limited else "at all: a deadlock"
    text = (
        "Several threads do not help here. By default, callbacks of the same callback group never run at the same "
        f"time, so nothing receives the response {until}. Use call_async, or give the client its own callback group."
    )
    return Cause("waits-in-callback", text, wait.where)


def _hangs(evidence: Evidence) -> bool:
    """Return whether the node sent no log line, command or request for at least SILENT_S after the last response."""
    recording = evidence.recording
    made = [call for call in recording.calls if not call.by_trial]
    answered = [call.answered_s for call in made if call.answered_s is not None]
    last_s = max(answered, default=None)
    if last_s is None or activity.end_s(recording) - last_s < SILENT_S:
        return False
    logged = (line.t_s for line in student_log.students(recording))
    sent = (*logged, *(command.t_s for command in activity.commands(recording)), *(call.t_s for call in made))
    return max(sent) <= last_s + ALSO_S


NEVER_WAITS = Kind(
    "never_waits",
    "trial",
    "The node never waits in a callback",
    NoParams,
    never_waits,
    early=_early,
    about="No callback calls a function that waits for a response, for a server or for time to pass (such as `call`, "
    "`spin_until_future_complete`, `wait_for_service` without a timeout, or `sleep`), even through an alias. In a node "
    "with several threads, a callback may wait for a response if the node continues after the response.",
)
