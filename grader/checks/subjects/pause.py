"""Check of a pause: the turtle stands still for a while, and then continues."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_blocked import idle_loop
from grader.checks.causes.why_condition import field_and_string
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_not_set import compared_condition
from grader.checks.causes.why_not_stored import not_stored, whole_request
from grader.checks.kind import Kind, number
from grader.checks.outcome import Finding, failed, passed
from grader.checks.subjects.path import moved_otherwise
from grader.checks.tolerance import Band
from grader.common.lazy import np
from grader.evidence.trajectory import RESTS_M

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.evidence.trajectory import Trajectory
    from grader.trial.recording import Command

EARLY_S = 0.1
"""Because of rounding, the trial may make a call up to this much (s) before the planned time."""
BEFORE_S = 1.0
"""The turtle must move at least once within this time (s) before the pause."""


@dataclass(frozen=True, kw_only=True)
class Pause:
    """From `from_s` to `until_s` (s) the turtle stands still.

    The turtle gets `within_s` (s) to stop, and the same time to start driving again after the pause.
    """

    from_s: float = number(at_least=0, about="The start of the pause, on the trial's clock.")
    until_s: float = number(above=0, about="The end of the pause, on the trial's clock.")
    within_s: float = number(0.5, above=0, about="The maximum time until the turtle stops, and until it continues.")
    goes_on: float = number(
        1.0, at_least=0, at_most=1, about="1 if the turtle must continue after the pause, and 0 if it need not."
    )


def pause(evidence: Evidence, params: Pause) -> Finding:
    """The turtle moves, and then stops and continues within the allowed times."""
    trajectory = evidence.trajectory
    within = Band.at_most(params.within_s)
    expected = f"The pause begins at {params.from_s:g} s, and the turtle has {params.within_s:g} s to stop."
    expected += f" The turtle continues at {params.until_s:g} s." if params.goes_on else ""
    where = evidence.place("create_service")
    moved = moved_otherwise(evidence, expected)
    if moved is not None:
        return moved
    crash = crash_of(evidence)
    if crash is not None and evidence.recording.end.t_s < params.until_s + params.within_s:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    if _moved(trajectory, params.from_s - BEFORE_S, params.from_s) is None:
        observed = f"The turtle did not move in the last {BEFORE_S:g} s before the pause."
        return failed(observed, expected, Cause("not-moving", where=where))
    last = _moved(trajectory, params.from_s, params.until_s)
    stop_s = 0.0 if last is None else last[1] - params.from_s
    near = within.near(stop_s)
    if not within.holds(stop_s):
        return _goes_on(evidence, params, stop_s, expected, near_edge=near)
    if not params.goes_on:
        return passed(f"The turtle stood still after {stop_s:.2f} s.", near_edge=near)
    first = _moved(trajectory, params.until_s, float("inf"))
    wait_s = float("inf") if first is None else first[0] - params.until_s
    near |= within.near(wait_s)
    if not within.holds(wait_s):
        observed = "The turtle did not continue." if first is None else f"The turtle continued after {wait_s:.1f} s."
        text = "The request with data=False ends the pause."
        cause = whole_request(evidence) or Cause("pause-never-ends", text, where)
        return failed(observed, expected, cause, near_edge=near)
    return passed("The turtle stood still and then continued.", near_edge=near)


def _goes_on(evidence: Evidence, params: Pause, stop_s: float, expected: str, *, near_edge: bool) -> Finding:
    where = evidence.place("create_service")
    inside = [command for command in evidence.commands if params.from_s + 0.1 < command.t_s < params.until_s]
    driving = any(map(_drives, inside))
    again_s = _drives_again_s(evidence, params)
    if again_s is not None:
        observed = (
            f"The same call arrived again at {again_s:.1f} s, while the node was paused, and the turtle drove again."
        )
        text = "Each call changes the state. The new state must not depend on the old state, but only on request.data."
        return failed(observed, expected, Cause("pause-toggles", text, where), near_edge=near_edge)
    if driving:
        observed = f"The turtle was still moving {stop_s:.1f} s after the call."
        text = (
            "The commands still move the turtle during the pause. While the node is paused, publish a command with "
            "all values 0."
        )
        if _is_reversed(evidence, params):
            observed += " After the next call, it stands still."
            text = "The node does the opposite of the request: data=True must pause it, and data=False must not."
        known = compared_condition(evidence) or field_and_string(evidence, "data") or not_stored(evidence)
        cause = known or Cause("pause-ignored", text, where)
        return failed(observed, expected, cause, near_edge=near_edge)
    observed = f"The turtle took {stop_s:.1f} s to stop after the call."
    text = "Without a new command, a turtle continues for one second. While the node is paused, publish zeros."
    cause = idle_loop(evidence) or Cause("no-stop-command", text, where)
    return failed(observed, expected, cause, near_edge=near_edge)


def _is_reversed(evidence: Evidence, params: Pause) -> bool:
    """Return whether the node sends only zeros after the pause, until the next call by the trial."""
    later = (call.t_s for call in evidence.recording.calls if call.by_trial and call.t_s > params.until_s + EARLY_S)
    until_s = min(later, default=float("inf"))
    after = [each for each in evidence.commands if params.until_s + params.within_s < each.t_s < until_s]
    return bool(params.goes_on and after) and not any(map(_drives, after))


def _drives_again_s(evidence: Evidence, params: Pause) -> float | None:
    """Return the time (s) of a call by the trial that repeats the previous call, or None.

    Such a call counts only if the node had stopped the turtle before it, and drove the turtle again after it.
    """
    calls = [call for call in evidence.recording.calls if call.by_trial and call.t_s >= params.from_s - EARLY_S]
    for first, second in pairwise(calls):
        if (first.service, first.request) == (second.service, second.request):
            before = [_drives(each) for each in evidence.commands if first.t_s < each.t_s < second.t_s]
            after = [_drives(each) for each in evidence.commands if second.t_s + EARLY_S < each.t_s < params.until_s]
            return second.t_s if before and not before[-1] and any(after) else None
    return None


def _drives(command: Command) -> bool:
    return bool(command.linear[0] or command.angular[2])


def _moved(trajectory: Trajectory, from_s: float, until_s: float) -> tuple[float, float] | None:
    """Return the first and the last time (s) at which the turtle moved between `from_s` and `until_s`, or None."""
    moving = (trajectory.steps > RESTS_M) & (trajectory.t_s > from_s) & (trajectory.t_s <= until_s)
    times = trajectory.t_s[np.flatnonzero(moving)]
    return (float(times[0]), float(times[-1])) if len(times) else None


PAUSE = Kind(
    "pause",
    "trial",
    "The turtle stands still and continues",
    Pause,
    pause,
    about="The turtle stands still between two times, for example from the trial's first call to the second call, and "
    "then continues (unless `goes_on` is 0).",
    drives=True,
)
