"""Check how the node ends: it runs until Ctrl-C and then exits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_ended import why_ended
from grader.checks.causes.why_ignored import why_ignored
from grader.checks.kind import Kind, number
from grader.checks.outcome import Finding, failed, passed
from grader.checks.tolerance import Band

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


@dataclass(frozen=True, kw_only=True)
class Stop:
    """The maximum wall time (s) from SIGINT to the exit of the node."""

    within_s: float = number(
        3.0, above=0, at_most=60, about="The maximum time that the node may run after Ctrl-C (wall time)."
    )


def stop(evidence: Evidence, params: Stop) -> Finding:
    """The node runs until SIGINT and exits soon after it. The exit code and any traceback do not matter."""
    end = evidence.recording.end
    expected = f"The node runs until Ctrl-C and then stops within {params.within_s:g} s."
    if end.by == "itself" or end.out_of is not None:
        return _too_early(evidence, expected)
    limit = Band.at_most(params.within_s)
    took = end.stop_s if end.stop_s is not None else float("inf")
    if end.by == "SIGINT" and limit.holds(took):
        return passed("The node stops on Ctrl-C.", near_edge=limit.near(took))
    if end.by == "SIGINT":
        observed = f"The node stopped {took:.1f} s after Ctrl-C."
        cause = "The node may still be waiting for something after Ctrl-C: a sleep, a thread or a service response."
        return failed(observed, expected, Cause("slow-stop", cause, evidence.place("spin")), near_edge=True)
    force = "it had to be killed" if end.by == "SIGKILL" else "only SIGTERM ended it"
    return failed(f"The node ignored Ctrl-C: {force}.", expected, why_ignored(evidence), near_edge=True)


def _too_early(evidence: Evidence, expected: str) -> Finding:
    crash = crash_of(evidence)
    if crash is not None:
        observed = end_observed(evidence) or f"After Ctrl-C, the node was stopped by force: {crash.observed}."
        return crash_finding(evidence, crash, observed, expected)
    why = why_ended(evidence)
    return failed(end_observed(evidence), expected, why)


STOP = Kind(
    "stops",
    "trial",
    "The node stops on Ctrl-C",
    Stop,
    stop,
    about="The node runs until Ctrl-C and ends soon after Ctrl-C. The node's exit code does not matter.",
)
