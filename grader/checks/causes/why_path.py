"""Explain why a trajectory is not the required circle, from the commands and the source code."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.words import number as shown
from grader.evidence import activity

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.where import Where
    from grader.trial.recording import Command

CHANGE = "The commands change. A circle needs the same command all the time."
AT_ONCE_S = 0.05
"""A command that follows another one within this time (s) is considered to replace it at once."""


def all_commands(evidence: Evidence) -> tuple[Command, ...]:
    """Return the commands before SIGINT, even if all of them arrived in the initial period (`activity.START_S`)."""
    until = activity.end_s(evidence.recording)
    return tuple(command for command in evidence.recording.commands if command.t_s < until)


def steady_command(evidence: Evidence) -> tuple[float, float] | None:
    """Return linear.x (m/s) and angular.z (rad/s) if these are the same in all commands, else None."""
    found = {(command.linear[0], command.angular[2]) for command in all_commands(evidence)}
    return next(iter(found)) if len(found) == 1 else None


def zeros_between(evidence: Evidence) -> bool:
    """Return whether a command with only zeros arrived between two other commands."""
    drives = "".join("01"[any(command.values)] for command in all_commands(evidence))
    return "10" in drives.rstrip("0")


def radius_of_commands(evidence: Evidence) -> str:
    """Return a sentence about the radius that follows from the commands, or "" if they change or are not finite."""
    speed = steady_command(evidence)
    if speed is None or not all(map(math.isfinite, speed)):
        return ""
    if not speed[1]:
        return "angular.z is 0, so the turtle drives in a straight line."
    ratio = speed[0] / speed[1]
    linear, angular = (shown(abs(value) if ratio < 0.0 else value) for value in speed)
    signs = ", without their signs" if ratio < 0.0 else ""
    return f"The radius is linear.x divided by angular.z{signs}: {linear} / {angular} = {shown(abs(ratio))} m."


def why_radius(evidence: Evidence) -> str:
    """Return a sentence about a wrong radius: how the radius follows from the commands, or that the commands change."""
    return CHANGE if steady_command(evidence) is None else radius_of_commands(evidence)


def why_elsewhere(evidence: Evidence) -> Cause:
    """Return the reason why a circle has the right size but is in the wrong place."""
    steady = steady_command(evidence)
    if steady is None:
        first, *_, last = all_commands(evidence)
        text = CHANGE
        if (first.linear, first.angular) != (last.linear, last.angular):
            text = (
                "The first command differs from the last one, so the turtle may have left its start position before "
                "the circle began."
            )
        return Cause("wrong-centre", text, line_of_values(evidence))
    if steady[0] < 0.0:
        text = (
            "linear.x is negative, so the turtle drives backwards, and the circle is on the other side of the turtle."
        )
        return Cause("wrong-centre", text, evidence.code.assigned("linear", "x") or line_of_values(evidence))
    return Cause("wrong-centre", where=line_of_values(evidence))


def why_replaced(evidence: Evidence) -> Cause | None:
    """Return the cause if a command with linear.x 0 follows at once after each command to drive, else None."""
    commands = evidence.commands
    after = {id(command): later for command, later in pairwise(commands)}
    driving = [command for command in commands[:-1] if command.linear[0]]
    if not driving or any(after[id(each)].linear[0] or after[id(each)].t_s - each.t_s > AT_ONCE_S for each in driving):
        return None
    publish = evidence.code.calls("publish")
    text = (
        "Some commands would move the turtle, but another command follows each of them at once, "
        "and the turtle follows only the last command."
    )
    return Cause("not-moving", text, publish[-1].where if publish else line_of_values(evidence))


def all_zero(evidence: Evidence) -> str:
    """Return a sentence if every command has linear.x 0 and angular.z 0, else an empty string.

    A second sentence names another field that is not 0.
    """
    commands = evidence.commands
    if not commands or any(command.linear[0] or command.angular[2] for command in commands):
        return ""
    text = "linear.x and angular.z are 0 in every command."
    for axis, field in ((1, "linear.y"), (2, "linear.z"), (3, "angular.x"), (4, "angular.y")):
        if any((*command.linear, *command.angular)[axis] for command in commands):
            return f"{text} {field} does not move the turtle."
    return text


def line_of_values(evidence: Evidence) -> Where | None:
    """Return the line that sets an angular field (or linear.x, if only linear fields change).

    If there is no such line, return the first of these that exists: a line that sets linear.x, a line that creates a
    Twist, a line that publishes, the node's file. If none exists, return None.
    """
    code = evidence.code
    if len({command.angular for command in evidence.commands}) == 1 < len({each.linear for each in evidence.commands}):
        return code.assigned("linear", "x") or evidence.place("Twist", "publish")
    turns = (code.assigned("angular", axis) for axis in "zxy")
    return next(filter(None, turns), None) or code.assigned("linear", "x") or evidence.place("Twist", "publish")
