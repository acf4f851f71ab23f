"""Checks of a node that cancels its goal on request: the cancellation, the response, and that no goal follows."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_blocked import why_blocked
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_no_goal import why_aborted
from grader.checks.kind import Kind, number, string
from grader.checks.outcome import Finding, Status, failed, passed
from grader.checks.subjects.goals import goals_of, no_goal
from grader.checks.subjects.services import calls_of, no_response
from grader.checks.tolerance import Band
from grader.trial.observed import MOST_GOALS

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.trial.observed import Call, Goal

SAME_TIME_S = 0.1
"""If a goal begins or succeeds within this time (s) of a call, the goal may be active or not when the call arrives."""


@dataclass(frozen=True, kw_only=True)
class CancelsGoal:
    """The service with which the trial tells the node to cancel its goal within `within_s` (s)."""

    service: str = string("the full name of a service", start="/", about="The service that the trial calls.")
    type: str = string("a service type, such as std_srvs/srv/Trigger", about="The type of the service.")
    within_s: float = number(0.5, above=0, about="The maximum time until the goal is cancelled.")


@dataclass(frozen=True, kw_only=True)
class SaysWhetherActive:
    """The service with which the trial tells the node to cancel its goal. The response has the field `success`."""

    service: str = string("the full name of a service", start="/", about="The service that the trial calls.")


@dataclass(frozen=True, kw_only=True)
class NoGoalAfter:
    """The service that the trial calls. After a call while a goal is active, the node must send no more goals."""

    service: str = string("the full name of a service", start="/", about="The service that the trial calls.")


def cancels_goal(evidence: Evidence, params: CancelsGoal) -> Finding:
    """When the trial calls the service, the turtle's current goal is cancelled in time."""
    expected = f"The goal is cancelled within {params.within_s:g} s after a call to {params.service}."
    calls = [call for call in calls_of(evidence) if call.by_trial and call.service == params.service]
    if not any(call.response is not None for call in calls):
        return no_response(evidence, params.service, params.type, calls[0] if calls else None, expected)
    goals = goals_of(evidence)
    found = _stopped(goals, calls)
    if found is None:
        if not goals:
            return no_goal(evidence, expected)
        observed = f"The turtle was not following a goal when {params.service} was called."
        text = "Until the service is called, the node must send the next goal as soon as the previous goal has ended."
        return failed(observed, expected, Cause("goal-not-sent", text, evidence.place("send_goal_async")))
    call, goal = found
    took = Band.at_most(params.within_s)
    if goal.status == "aborted" and goal.ended_s is not None and took.holds(goal.ended_s - call.t_s):
        observed, cause = why_aborted(evidence, goals, goal)
        observed += " The node did not cancel the goal." if goal.cancel_asked_s is None else ""
        return failed(observed, expected, cause)
    took_s = float("inf") if goal.cancel_asked_s is None or goal.ended_s is None else goal.ended_s - call.t_s
    if goal.status == "canceled" and took.holds(took_s):
        return passed("The goal was cancelled.", near_edge=took.near(took_s))
    return _goes_on(evidence, params, goal, took_s, expected)


def _goes_on(evidence: Evidence, params: CancelsGoal, goal: Goal, took_s: float, expected: str) -> Finding:
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    where = evidence.place("cancel_goal_async", "create_service")
    if goal.status == "canceled":
        return failed(
            f"The goal was cancelled {took_s:.1f} s after the call.",
            expected,
            Cause("goal-goes-on", "Cancel the goal in the callback of the service.", where),
            near_edge=Band.at_most(params.within_s).near(took_s),
        )
    text = "cancel_goal_async of the goal handle requests the cancellation."
    cause = why_blocked(evidence) or Cause("goal-goes-on", text, where)
    observed = f"After the call to {params.service}, the turtle continued to turn towards its goal."
    return failed(observed, expected, cause)


def no_goal_after(evidence: Evidence, params: NoGoalAfter) -> Finding:
    """After the trial's first call to the service during a goal, no goal arrives."""
    expected = f"After a call to {params.service}, the node sends no more goals."
    calls = [call for call in calls_of(evidence) if call.by_trial and call.service == params.service]
    goals = goals_of(evidence)
    found = _stopped(goals, calls)
    if found is None:
        return Finding(Status.SKIPPED, "Not judged, because no goal was active when the service was called.")
    if len(evidence.recording.goals) >= MOST_GOALS:
        observed = f"The node sent {MOST_GOALS} goals or more, and the recording may not contain all of them."
        return failed(observed, expected, Cause("goal-after-cancel", "", evidence.place("send_goal_async")))
    after = [goal for goal in goals if goal.t_s > found[0].t_s]
    if after:
        observed = f"The node sent another goal {after[0].t_s - found[0].t_s:.1f} s after the call."
        text = (
            "A cancelled goal also has a result, and the callback for the result is called. Check the status of the "
            "result."
        )
        nodes = (node for module in evidence.code.modules for node in module.nodes)
        checked = any(isinstance(node, ast.Attribute) and node.attr == "status" for node in nodes)
        if checked or not evidence.code.calls("get_result_async"):
            text = "Which callback sends this goal? After a call to the service, no callback may send one."
        return failed(observed, expected, Cause("goal-after-cancel", text, evidence.place("get_result_async")))
    return passed("No goal arrived after the call.")


def says_whether_active(evidence: Evidence, params: SaysWhetherActive) -> Finding:
    """In each response, `success` is true if a goal was active when the call arrived, and false if not."""
    expected = f"In the response from {params.service}, success is true if a goal was active, and false if not."
    goals = goals_of(evidence)
    calls = [call for call in calls_of(evidence) if call.by_trial and call.service == params.service]
    if not calls:
        return no_response(evidence, params.service, "", None, expected)
    for call in calls:
        if call.response is None:
            return no_response(evidence, params.service, call.type, call, expected)
        active = _is_active(goals, call.t_s)
        said = call.response.get("success")
        if active is not None and said is not active:
            was = "was" if active else "was not"
            observed = f"The turtle {was} following a goal at {call.t_s:.1f} s, but success was {str(said).lower()}."
            return failed(observed, expected, _other_success(evidence, goals, call))
    return passed("success was true if a goal was active, and false if not.")


def _other_success(evidence: Evidence, goals: list[Goal], call: Call) -> Cause:
    """Return the cause of a wrong `success`: a goal that has ended still counts, or `success` is set incorrectly."""
    ended = [goal for goal in goals if goal.ended_s is not None and goal.ended_s <= call.t_s]
    others = [each for each in evidence.recording.calls if each.by_trial and each.service == call.service]
    right = [each for each in others if each.t_s < call.t_s and (each.response or {}).get("success") is True]
    said = call.response is not None and call.response.get("success") is True
    if said and ended and right and not _always_true(evidence):
        text = (
            "The goal had ended before this call, and the node still counted it as active. "
            "When a goal has ended, discard its handle."
        )
        return Cause("wrong-response", text, evidence.place("get_result_async"))
    text = "Set success in the callback of the service, before the goal is cancelled: it is true if a goal was active."
    return Cause("wrong-response", text, evidence.place("create_service"))


def _always_true(evidence: Evidence) -> bool:
    """Return whether every assignment to an attribute `success` assigns True, or there is no such assignment."""
    assigned = [node for module in evidence.code.modules for node in module.nodes if isinstance(node, ast.Assign)]
    values = [
        node.value
        for node in assigned
        if any(isinstance(target, ast.Attribute) and target.attr == "success" for target in node.targets)
    ]
    return all(isinstance(value, ast.Constant) and value.value is True for value in values)


def _is_active(goals: list[Goal], t_s: float) -> bool | None:
    """Return whether a goal is active at this time (s), or None if a goal begins or succeeds at about the same time."""
    for goal in goals:
        ended_s = goal.ended_s if goal.status == "succeeded" else None
        if any(each_s is not None and abs(each_s - t_s) < SAME_TIME_S for each_s in (goal.t_s, ended_s)):
            return None
    return any(goal.t_s < t_s and (goal.ended_s is None or goal.ended_s > t_s) for goal in goals)


def _stopped(goals: list[Goal], calls: list[Call]) -> tuple[Call, Goal] | None:
    """Return the first call that arrived while a goal was active, together with that goal, or None."""
    for call in calls:
        for goal in goals:
            if goal.t_s < call.t_s and (goal.ended_s is None or goal.ended_s > call.t_s):
                return call, goal
    return None


CANCELS_GOAL = Kind(
    "cancels_goal",
    "trial",
    "The node cancels its goal",
    CancelsGoal,
    cancels_goal,
    about="When a `[[trial.call]]` requests it, the node cancels the goal of `/turtle1/rotate_absolute` in time.",
)
NO_GOAL_AFTER = Kind(
    "no_goal_after",
    "trial",
    "No goal follows a cancelled one",
    NoGoalAfter,
    no_goal_after,
    about="After the first `[[trial.call]]` to the service during a goal, the node sends no more goals to "
    "`/turtle1/rotate_absolute`.",
)
SAYS_WHETHER_ACTIVE = Kind(
    "says_whether_active",
    "trial",
    "The response shows whether there was a goal",
    SaysWhetherActive,
    says_whether_active,
    about="In the response to each `[[trial.call]]` to the service, `success` shows whether a goal of "
    "`/turtle1/rotate_absolute` was active.",
)
