"""Explain why no goal reaches the action (for example, because its name is wrong), or why a goal is aborted."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_blocked import why_blocked
from grader.checks.causes.why_silent import why_nothing
from grader.common.words import shorten

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.trial.observed import Goal

FEEDBACK = "/_action/feedback"
OF_A_TYPE = "_FeedbackMessage"
SENDS = ("send_goal_async", "send_goal")
ONE_FRAME_S = 0.04
"""An event may have aborted a goal if it was recorded between this time (s) before the goal was sent and this time
after the goal ended. Two frames of turtlesim take less time."""


def why_no_goal(evidence: Evidence, action: str, type_name: str) -> Cause:
    """Return the most likely cause if no goal reaches this action of the simulator."""
    code = evidence.code
    where = evidence.place("ActionClient")
    if not code.calls("ActionClient"):
        return Cause("goal-not-sent", "The node has no ActionClient.", code.start)
    return (
        _other_client(evidence, action, type_name)
        or why_blocked(evidence)
        or why_nothing(evidence, SENDS)
        or (
            Cause("goal-not-sent", "", evidence.place(*SENDS))
            if any(code.calls(name) for name in SENDS)
            else Cause(
                "goal-not-sent",
                "Creating a client sends nothing. The client's method send_goal_async sends a goal.",
                where,
            )
        )
    )


def _other_client(evidence: Evidence, action: str, type_name: str) -> Cause | None:
    """Return the cause if the node is a client of another action, or uses another type for this action, else None."""
    ours = evidence.recording.own_nodes
    found = {
        (end.topic.removesuffix(FEEDBACK), end.type.removesuffix(OF_A_TYPE))
        for graph in evidence.recording.graphs
        for end in graph.endpoints
        if end.kind == "subscription" and end.topic.endswith(FEEDBACK) and end.node not in ours
    }
    where = evidence.place("ActionClient")
    if not found or (action, type_name) in found:
        return None
    name, type_ = min(found, key=lambda client: client[0] != action)
    if name == action:
        text = f"The client has the type {shorten(type_)}. The action has the type {type_name}."
        return Cause("action-type", text, where)
    text = (
        f"The client uses the name {shorten(name)}. The name of the action is {action}, which includes the name "
        "of the turtle."
    )
    return Cause("action-name", text, where)


def why_aborted(evidence: Evidence, goals: list[Goal], goal: Goal) -> tuple[str, Cause]:
    """Return two values: a sentence about the event that aborted this goal, and the cause."""
    until_s = (goal.t_s if goal.ended_s is None else goal.ended_s) + ONE_FRAME_S
    later = [each for each in goals[goals.index(goal) + 1 :] if each.t_s <= until_s]
    if later:
        text = (
            "An action of turtlesim executes one goal at a time: a second goal aborts the first. Send the next goal "
            "in the "
            "callback that receives the result."
        )
        cause = Cause("goal-replaced", text, evidence.place(*SENDS))
        return f"A second goal at {later[0].t_s:.1f} s aborted the goal sent at {goal.t_s:.1f} s.", cause
    commands = [each for each in evidence.commands if goal.t_s - ONE_FRAME_S <= each.t_s <= until_s]
    if commands:
        text = "Any command aborts the goal, even one with only zeros. Publish nothing while the turtle follows a goal."
        cause = Cause("goal-aborted-by-command", text, evidence.place("publish"))
        return f"A velocity command at {commands[-1].t_s:.1f} s aborted the goal sent at {goal.t_s:.1f} s.", cause
    return f"The goal sent at {goal.t_s:.1f} s was aborted.", Cause("goal-aborted", where=evidence.place(*SENDS))
