"""Check of a drive to a goal: the turtle arrives and stops there."""

from __future__ import annotations

import ast
import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_steering import compared_exactly, why_steering
from grader.checks.kind import Kind, number
from grader.checks.outcome import Finding, failed, passed
from grader.checks.requested import Requested
from grader.checks.subjects.path import MOVED_M, not_driven
from grader.checks.subjects.standstill import no_standstill
from grader.checks.tolerance import Band
from grader.common.lazy import np
from grader.common.words import count

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.where import Where

STROKE_M = 0.3
"""The length (m) of each of the four lines that point to a goal in a drawing."""


@dataclass(frozen=True, kw_only=True)
class Goal:
    """The position of the goal (m), and the largest allowed distance (m) between the turtle and the goal at the end."""

    x_m: float = number(about="The x coordinate of the goal.")
    y_m: float = number(about="The y coordinate of the goal.")
    tolerance_m: float = number(0.1, above=0, about="The maximum distance from the goal at the end.")


SWAYS, SWAYS_LEAST = 0.4, 5
"""A turtle sways if at least this fraction of its turning commands, and at least this number of them, turn it in the
opposite direction to the previous command."""
LATE_S = 1.0
"""A turtle that came nearer to the goal in this last part of the trial (s) might have reached the goal later."""
NEARLY_M = 1.0
"""If the turtle stops within this distance (m) of the goal, and the goal's coordinates are constants in the code, the
node may have stopped the turtle too early."""


def goal(evidence: Evidence, params: Goal) -> Finding:
    """The turtle drives to the goal and stops there."""
    expected = f"The turtle stops within {params.tolerance_m:g} m of x={params.x_m:g} y={params.y_m:g}."
    where = evidence.place("publish")
    still = not_driven(evidence, expected, where)
    trajectory = evidence.trajectory
    if still is not None:
        if still.diagnosis != "not-moving" or trajectory.turned_rad < math.tau:
            return still
        steering = why_steering(evidence)
        if steering is not None:
            return still.because(steering)
        turns = count(round(trajectory.turned_rad / math.tau), "full turn")
        text = (
            f"The turtle only turned on the spot, by {turns} in total. "
            "The angle to turn by is the direction to the goal minus theta."
        )
        where = evidence.code.assigned("angular", "z") or where
        return still.because(Cause("turns-on-the-spot", text, where))
    away = np.hypot(trajectory.x - params.x_m, trajectory.y - params.y_m)
    end = float(away[-1])
    moving = no_standstill(evidence, expected)
    close = Band.at_most(params.tolerance_m)
    near = close.near(end)
    if not close.holds(end):
        return replace(_not_there(evidence, params, expected, where), near_edge=near)
    if moving is not None:
        exact = compared_exactly(evidence)
        return moving if exact is None else moving.because(exact)
    start = math.dist((float(trajectory.x[0]), float(trajectory.y[0])), (params.x_m, params.y_m))
    return passed(f"The turtle drove to its goal, {start:.1f} m away, and stopped.", near_edge=near)


def _not_there(evidence: Evidence, params: Goal, expected: str, where: Where | None) -> Finding:
    """Return the finding about a turtle that drove, but is not at the goal at the end."""
    trajectory = evidence.trajectory
    away = np.hypot(trajectory.x - params.x_m, trajectory.y - params.y_m)
    end, nearest = float(away[-1]), float(away.min())
    observed = f"The turtle ends at x={trajectory.x[-1]:.2f} y={trajectory.y[-1]:.2f}, {end:.2f} m from the goal."
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, f"{observed} {end_observed(evidence)}", expected)
    unknown = _not_in_code(evidence, params)
    if unknown is not None:
        return failed(observed, expected, unknown.at(where))
    if Band.at_most(params.tolerance_m).holds(nearest):
        observed += f" On the way, the turtle came within {nearest:.2f} m of the goal."
        cause = "The turtle does not stop at the goal. Near the goal, publish a command with all values 0."
        return failed(observed, expected, compared_exactly(evidence) or Cause("goes-on", cause, where))
    steering = why_steering(evidence)
    if steering is not None:
        return failed(observed, expected, steering)
    last = evidence.commands[-1] if evidence.commands else None
    if last is not None and no_standstill(evidence, expected) is None and not (last.linear[0] or last.angular[2]):
        cause = (
            "The last command stops the turtle, as if it had arrived. "
            "Compare the position of the goal in the code with the position in the task."
        )
        if end <= NEARLY_M and _in_code(evidence, params.x_m, params.y_m):
            cause = (
                "The last command stops the turtle, as if it had arrived. "
                f"At which distance from the goal does the node stop? The turtle ended {end:.1f} m from the goal."
            )
        return failed(observed, expected, Cause("not-there", cause, where))
    if end >= away[0] - MOVED_M:
        cause = "The direction to the goal is atan2(goal_y - y, goal_x - x). The direction of the turtle is theta."
        return failed(observed, expected, Cause("away-from-goal", cause, where))
    return failed(observed, expected, Cause("not-there", _on_the_way(evidence, params), where))


def _on_the_way(evidence: Evidence, params: Goal) -> str:
    """Describe the drive of a turtle that ends nearer to the goal than it started, but not at the goal."""
    trajectory = evidence.trajectory
    if trajectory.wall.any():
        return (
            "The turtle ran into a wall. Bring the error into the range from -pi to pi, with "
            "atan2(sin(error), cos(error))."
        )
    turns = [command.angular[2] for command in evidence.commands if command.angular[2]]
    changes = sum(before * after < 0 for before, after in pairwise(turns))
    if changes >= max(SWAYS_LEAST, SWAYS * len(turns)):
        return (
            "The turtle sways: many commands turn it in the opposite direction to the command before. It turns too far "
            "between two commands, so the gain may be too large."
        )
    away = np.hypot(trajectory.x - params.x_m, trajectory.y - params.y_m)
    nearest = int(away.argmin())
    near_s = float(trajectory.t_s[max(nearest - 1, 0)])
    late = int(np.searchsorted(trajectory.t_s, trajectory.t_s[-1] - LATE_S))
    if away[-1] < min(float(away[:late].min(initial=math.inf)), away[late]) - MOVED_M:
        return "The turtle was still getting nearer to the goal at the end of the trial, so it may need more time."
    return f"The turtle came within {away[nearest]:.2f} m of the goal at {near_s:.1f} s, and no nearer after that."


def _in_code(evidence: Evidence, *numbers: float) -> bool:
    """Return whether all these numbers are constants of the type float in the code of the node."""
    nodes = [node for module in evidence.code.modules for node in module.nodes]
    found = {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, float)}
    return found.issuperset(numbers)


def _not_in_code(evidence: Evidence, params: Goal) -> Cause | None:
    """Return the cause if the code contains no coordinate of the goal, else None."""
    goal = {params.x_m, params.y_m}
    nodes = [node for module in evidence.code.modules for node in module.nodes]
    if not nodes or any(isinstance(node, ast.Constant) and node.value in goal for node in nodes):
        return None
    text = f"The code contains neither {params.x_m:g} nor {params.y_m:g}, the coordinates of the goal."
    return Cause("not-there", text)


def requested_goal(_: Evidence, params: Goal) -> Requested:
    """Return a circle of all positions at which the goal is reached, and four lines that point to this circle."""
    x, y = params.x_m, params.y_m
    near, far = params.tolerance_m, params.tolerance_m + STROKE_M
    rays = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
    strokes = tuple(((x + near * a, y + near * b), (x + far * a, y + far * b)) for a, b in rays)
    return Requested(f"x={x:g} y={y:g}", (((x, y), params.tolerance_m),), strokes)


GOAL = Kind(
    "goal",
    "trial",
    "The turtle drives to its goal",
    Goal,
    goal,
    about="Velocity commands drive the turtle to the goal, where it stands still at the end.",
    drives=True,
    requested=requested_goal,
)
