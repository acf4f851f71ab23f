"""Checks of a client of the action rotate_absolute: its goals, their outcomes, and its requests for the results."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_blocked import why_blocked
from grader.checks.causes.why_condition import field_and_string
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_no_goal import SENDS, why_aborted, why_no_goal
from grader.checks.causes.why_unread import why_unread
from grader.checks.kind import Kind, NoParams, number
from grader.checks.outcome import Finding, failed, passed
from grader.checks.tolerance import Band
from grader.common.words import count
from grader.evidence import activity
from grader.evidence.interventions import ROTATE
from grader.turtlesim.turtle import normalize

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.trial.observed import Goal

TYPE = "turtlesim/action/RotateAbsolute"
SAME_RAD = 0.02
SAME = "This heading is the same as in the previous goal. The heading must change before the next goal is sent."
HALF_TURN_S = 3.2
"""The longest time (s) that the turtle needs to reach a goal: it turns by at most pi rad, at 1 rad/s."""
STILL_DRIVES_S = 0.5
"""If the node drives the turtle within this time (s) before the end of the trial, its drive has not ended."""
CONVERTED_RAD = 1e-4
TURNS_RAD = 20.0 * math.pi
"""A goal that is larger than this (rad), ten full turns, is an angle in degrees."""
LARGE_RAD = 7.0
"""A larger angle than this (rad) is more than a full turn, so it may be in degrees."""


@dataclass(frozen=True, kw_only=True)
class SendsGoals:
    """A sequence of `total` goals, beginning with goal number `nth`.

    Each heading is `turn_deg` to the left of the previous heading.
    """

    heading_deg: float = number(about="The heading of goal number `nth`, in degrees: 0 is to the right, 90 is up.")
    nth: float = number(1, at_least=1, about="The number of the first goal that is compared, counted from 1.")
    total: float = number(1, at_least=1, about="The number of goals that are compared.")
    turn_deg: float = number(0.0, about="The angle to the left from one goal to the next.")
    tolerance_deg: float = number(1.0, above=0, about="The maximum error of a heading.")


def sends_goals(evidence: Evidence, params: SendsGoals) -> Finding:
    """The goals arrive one after the other, with these headings, and each is reached, or cancelled after a call."""
    goals = goals_of(evidence)
    first, amount = int(params.nth) - 1, int(params.total)
    headings = [params.heading_deg + each * params.turn_deg for each in range(amount)]
    expected = f"Goal {first + 1} of the node is a heading of {headings[0]:g} degrees, and the turtle reaches it."
    if amount > 1:
        expected = (
            f"The turtle reaches {amount} goals, the first at {headings[0]:g} degrees, and each following goal "
            f"{params.turn_deg:g} degrees further to the left."
        )
    if not goals:
        return no_goal(evidence, expected)
    for goal in goals[: first + amount]:
        if goal.status == "aborted":
            observed, cause = why_aborted(evidence, goals, goal)
            return failed(observed, expected, cause)
    near = Band.around(0.0, params.tolerance_deg)
    edge = False
    for index, (goal, heading) in enumerate(zip(goals[first : first + amount], headings, strict=False)):
        off = math.degrees(normalize(goal.request["theta"] - math.radians(heading)))
        edge |= near.near(off)
        if not near.holds(off):
            turned = _other_turn(goals[first + index - 1], goal, params.turn_deg) if index else ""
            turned = turned or (_again(goals[first - 1], goal) if first else "")
            return _other_heading(evidence, goal, heading, turned, expected, near_edge=near.near(off))
        if not _reached(evidence, goal):
            return _not_reached(evidence, goal, expected)
    if len(goals) < first + amount:
        return _no_more(evidence, goals, expected)
    cancelled = any(goal.status == "canceled" for goal in goals[first : first + amount])
    reached = "The goals were right, and one was cancelled after the trial's first call."
    return passed(reached if cancelled else f"The turtle reached {count(amount, 'goal')}.", near_edge=edge)


def goals_of(evidence: Evidence) -> list[Goal]:
    """Return the goals for turtle1 before the end of the scenario, in order."""
    until = activity.end_s(evidence.recording)
    return [goal for goal in evidence.recording.goals if goal.action == ROTATE and goal.t_s < until]


def first_call_s(evidence: Evidence) -> float:
    """Return the time (s) of the trial's first call to a service of the node, or infinity if there is no call."""
    return min((call.t_s for call in evidence.recording.calls if call.by_trial), default=math.inf)


def _reached(evidence: Evidence, goal: Goal) -> bool:
    """Return whether the turtle reached the goal, or the goal was cancelled after the trial's first call."""
    by_trial = goal.cancel_asked_s is not None and goal.cancel_asked_s >= first_call_s(evidence)
    return goal.status == "succeeded" or (goal.status == "canceled" and by_trial)


def _not_reached(evidence: Evidence, goal: Goal, expected: str) -> Finding:
    crash, ended = crash_of(evidence), end_observed(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, ended, expected)
    observed = f"The goal sent at {goal.t_s:.1f} s was not reached by the end: its status is {goal.status}."
    text = ""
    if goal.status == "canceled":
        text = "The node itself cancelled the goal."
    elif not ended and goal.t_s > activity.end_s(evidence.recording) - HALF_TURN_S:
        text = "The node sent this goal too late."
    cause = Cause("goal-not-reached", text, evidence.place(*SENDS))
    return failed(f"{ended} {observed}".strip(), expected, cause)


def no_goal(evidence: Evidence, expected: str) -> Finding:
    """Return the failed finding about a node that sent no goal."""
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    return failed(f"No goal arrived at {ROTATE}.", expected, why_no_goal(evidence, ROTATE, TYPE))


def _no_more(evidence: Evidence, goals: list[Goal], expected: str) -> Finding:
    crash = crash_of(evidence)
    observed = f"The node sent {count(len(goals), 'goal')}, and then no more."
    if crash is not None:
        return crash_finding(evidence, crash, f"{observed} {end_observed(evidence)}", expected)
    if goals[-1].result_asked_s is None:
        return failed(observed, expected, why_blocked(evidence) or _no_result(evidence))
    text = "The callback that receives the result must send the next goal."
    drove_s = _drove_until_s(evidence, goals[-1])
    if drove_s is not None:
        text = "The node drove the turtle after this goal. When the drive has ended, the node must send the next goal."
        if drove_s > activity.end_s(evidence.recording) - STILL_DRIVES_S:
            text = "After this goal, the node drove until the end of the trial. Which condition ends the drive?"
    cause = (
        why_blocked(evidence)
        or why_unread(evidence)
        or field_and_string(evidence, "status")
        or Cause("goal-not-sent", text, evidence.place("get_result_async", *SENDS))
    )
    return failed(observed, expected, cause)


def _drove_until_s(evidence: Evidence, goal: Goal) -> float | None:
    """Return the time (s) of the last command that drove the turtle after the end of this goal, or None."""
    ended_s = math.inf if goal.ended_s is None else goal.ended_s
    return max((each.t_s for each in evidence.commands if each.t_s >= ended_s and any(each.linear)), default=None)


def _no_result(evidence: Evidence) -> Cause:
    text = (
        "The first response only says that the goal was accepted. get_result_async of the goal handle requests the "
        "result, which arrives when the goal ends."
    )
    return Cause("result-not-awaited", text, evidence.place("get_result_async", *SENDS))


def _other_turn(before: Goal, goal: Goal, turn_deg: float) -> str:
    """Return a sentence that explains why the heading of a goal is wrong, given the heading of the previous goal."""
    theta = float(goal.request["theta"])
    if abs(normalize(theta - math.radians(turn_deg))) <= SAME_RAD:
        return "A goal is an absolute heading, not a turn: 0 is to the right, whatever the heading was before."
    more = math.degrees(normalize(theta - float(before.request["theta"])))
    if abs(more) < 0.5:  # shown as 0 degrees
        return SAME
    return (
        f"This heading is {_degrees(abs(more))} further to the {'left' if more >= 0 else 'right'} than the previous "
        f"one. The exercise asks for {turn_deg:g} degrees to the left."
    )


def _degrees(angle: float) -> str:
    """Return '1 degree' or '40 degrees'. The angle can be NaN."""
    shown = f"{angle:.0f}"
    return f"{shown} degree{'' if shown.lstrip('-') == '1' else 's'}"


def _again(before: Goal, goal: Goal) -> str:
    """Return a sentence if the heading is that of the previous goal, or has the opposite sign, else ""."""
    theta, earlier = float(goal.request["theta"]), float(before.request["theta"])
    if abs(normalize(theta - earlier)) <= SAME_RAD:
        return SAME
    if abs(theta + earlier) <= SAME_RAD:
        return "This is the heading of the previous goal with the opposite sign."
    return ""


def _other_heading(
    evidence: Evidence, goal: Goal, heading: float, turned: str, expected: str, *, near_edge: bool
) -> Finding:
    theta = float(goal.request["theta"])
    where = evidence.code.assigned("theta") or evidence.place("Goal", *SENDS)
    degrees = _degrees(math.degrees(theta))
    observed = f"The goal sent at {goal.t_s:.1f} s has theta={theta:.2f} rad, which is {degrees}."
    if abs(theta) > LARGE_RAD and abs(theta - heading) < 1.0:
        text = "The field theta is in radians. math.radians converts degrees to radians."
        return failed(observed, expected, Cause("degrees", text, where), near_edge=near_edge)
    if TURNS_RAD < abs(theta) < math.inf:
        text = "theta is in radians, and this is more than ten full turns. math.radians converts degrees to radians."
        return failed(observed, expected, Cause("degrees", text, where), near_edge=near_edge)
    if abs(theta - math.radians(math.radians(heading))) <= CONVERTED_RAD:
        text = "This is the heading converted from degrees to radians twice. math.radians must be called only once."
        return failed(observed, expected, Cause("degrees", text, where), near_edge=near_edge)
    if abs(normalize(theta + math.radians(heading))) <= SAME_RAD:
        text = "Angles increase to the left, which is counter-clockwise."
        return failed(observed, expected, Cause("wrong-sign", text, where), near_edge=near_edge)
    text = (
        turned
        or "Compare this heading with the one that the exercise asks for. A heading is absolute: 0 is to the right."
    )
    return failed(observed, expected, Cause("wrong-goal", text, where), near_edge=near_edge)


def awaits_result(evidence: Evidence, _: NoParams) -> Finding:
    """The node requested the result of each goal that was reached. If no goal was reached, all goals are judged."""
    expected = "The node asks for the result of each goal."
    goals = goals_of(evidence)
    if not goals:
        return no_goal(evidence, expected)
    judged = [goal for goal in goals if goal.status == "succeeded"] or goals
    without = [goal for goal in judged if goal.result_asked_s is None]
    if without:
        observed = f"The node never asked for the result of the goal sent at {without[0].t_s:.1f} s."
        return failed(observed, expected, why_blocked(evidence) or _no_result(evidence))
    return passed(f"The node asked for the result of {count(len(judged), 'goal')}.")


SENDS_GOALS = Kind(
    "sends_goals",
    "trial",
    "The node sends a goal",
    SendsGoals,
    sends_goals,
    about="The node sends goals to `/turtle1/rotate_absolute`, one after the other, and the turtle reaches each one, "
    "unless the node cancels it after the first call by the trial.",
)
AWAITS_RESULT = Kind(
    "awaits_result",
    "trial",
    "The node asks for the result",
    NoParams,
    awaits_result,
    about="The node asks for the result of each goal that the turtle reached.",
)
