"""Checks of the turtle's trajectory: it is the right circle, and it does not touch a wall."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed, ended_early
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_path import (
    CHANGE,
    all_commands,
    all_zero,
    line_of_values,
    radius_of_commands,
    steady_command,
    why_elsewhere,
    why_radius,
    why_replaced,
    zeros_between,
)
from grader.checks.causes.why_stopped import cancelled, stopped_by_exit
from grader.checks.kind import Kind, NoParams, choice, number
from grader.checks.outcome import Finding, Status, failed, passed
from grader.checks.requested import Requested
from grader.checks.tolerance import Band
from grader.common.words import count, shorten
from grader.common.words import number as shown
from grader.evidence import activity
from grader.evidence.interventions import ALWAYS, moved_by
from grader.evidence.trajectory import driven_from

if TYPE_CHECKING:
    from grader.evidence.circle_fit import Circle
    from grader.evidence.evidence import Evidence
    from grader.evidence.trajectory import Trajectory
    from grader.submission.where import Where
    from grader.trial.recording import Pose

NO_COMMAND = "The turtle stops when no command arrives for 1 s."
MOVED_M = 0.05
"""A turtle with a shorter trajectory than this (m) did not move."""
TURNED_RAD = 0.1
STRAIGHT_RADIUS_M = 50.0
"""An arc with a larger radius than this (m) looks straight in turtlesim's window, which is 11 m wide."""
LIVES_S = 1.0
"""The time (s) for which a turtle moves after a single command."""
LATE_S = 3.0
"""If the first command arrives later than this (s), the delay may be the reason why the turtle drives too little."""
POLYGON_SHARE = 0.6
"""If more than this fraction of the trajectory is straight, the message describes a straight line or a polygon."""


@dataclass(frozen=True, kw_only=True)
class CircleParams:
    """A circle that the turtle must drive.

    The circle's centre is `radius_m` to the left of the pose before the first command (or to the right if clockwise).

    `residual_m` is the largest allowed root mean square distance between the trajectory and the fitted circle. `turns`
    is the smallest allowed number of turns.
    """

    radius_m: float = number(
        above=0,
        at_most=5.5,
        about=(
            "The radius, which is also the distance from the start to the centre. The centre is to the left of the "
            "start, or to the right if the direction is clockwise."
        ),
    )
    radius_tolerance_m: float = number(0.05, above=0, about="The maximum error in the radius.")
    centre_tolerance_m: float = number(0.05, above=0, about="The maximum error in the centre.")
    residual_m: float = number(
        0.02, above=0, about="The maximum deviation of the trajectory from the fitted circle (root mean square)."
    )
    turns: float = number(1.0, above=0, about="The minimum number of turns.")
    direction: str = choice("counter-clockwise", "clockwise", about="The direction of the turn.")


def expected_centre(start: Pose, params: CircleParams) -> tuple[float, float]:
    """Return the centre (m) of the expected circle for a turtle with this start pose."""
    side = 1.0 if params.direction == "counter-clockwise" else -1.0
    return (
        start.x - side * params.radius_m * math.sin(start.theta),
        start.y + side * params.radius_m * math.cos(start.theta),
    )


def circle(evidence: Evidence, params: CircleParams) -> Finding:
    """The turtle drives the circle: it is round, with the right direction, size, place and number of turns."""
    turns = "1 turn" if params.turns == 1.0 else f"{params.turns:g} turns"
    expected = (
        f"The turtle drives a circle of radius {shown(params.radius_m)} m, {params.direction}, for at least {turns}."
    )
    moved = moved_otherwise(evidence, expected)
    if moved is not None:
        return moved
    trajectory = evidence.trajectory
    return _no_circle(evidence, trajectory, expected) or _measured(evidence, params, trajectory, expected)


def moved_otherwise(evidence: Evidence, expected: str, *, from_start: bool = False) -> Finding | None:
    """Return a failed finding if a call moved the turtle or may have changed its movement, else None.

    With `from_start`, movements before the first command also count.
    """
    means = moved_by(evidence.recording, from_start=from_start)
    if means is None:
        return None
    did = "may have changed the turtle's movement" if means in ALWAYS else "moved the turtle"
    observed = f"Something other than a velocity command {did}: {shorten(means)}."
    cause = "Drive the turtle only with velocity commands."
    return failed(observed, expected, Cause("intervention", cause, evidence.place("create_client", "ActionClient")))


def not_driven(evidence: Evidence, expected: str, where: Where | None) -> Finding | None:
    """Return a failed finding if velocity commands did not drive the turtle, else None.

    The finding says that something else moved the turtle, that the turtle's position became NaN, or that the turtle did
    not drive.
    """
    moved = moved_otherwise(evidence, expected, from_start=True) or not_finite(evidence, expected)
    if moved is not None or evidence.trajectory.length_m > MOVED_M:
        return moved
    return failed("The turtle did not drive.", expected, Cause("not-moving", where=where))


def not_finite(evidence: Evidence, expected: str) -> Finding | None:
    """Return a failed finding if a command made the position of the turtle NaN, else None."""
    if evidence.trajectory.finite:
        return None
    cause = Cause("not-a-number", "A command contained a number that is not finite.", line_of_values(evidence))
    return failed("The turtle's position became NaN (not a number).", expected, cause)


def _no_circle(evidence: Evidence, trajectory: Trajectory, expected: str) -> Finding | None:
    """Return a failed finding with the most helpful reason if the trajectory is nothing like a circle, else None."""
    nowhere = not_finite(evidence, expected)
    if nowhere is not None:
        return nowhere
    if trajectory.length_m <= MOVED_M:
        if trajectory.turned_rad > TURNED_RAD:
            cause = "linear.x is the forward speed. Without linear.x, the turtle turns on the spot."
            why = why_replaced(evidence) or Cause("turns-on-the-spot", cause, line_of_values(evidence))
            return failed("The turtle turned on the spot.", expected, replace(why, diagnosis="turns-on-the-spot"))
        crash = crash_of(evidence)
        if crash is not None:
            return crash_finding(evidence, crash, f"The turtle did not move. {end_observed(evidence)}", expected)
        early = ended_early(evidence)
        if early and all_zero(evidence) == "":
            ended = Cause("ended-early", early, evidence.place("publish"))
            return failed("The turtle did not move.", expected, ended)
        why = why_replaced(evidence) or Cause("not-moving", all_zero(evidence), line_of_values(evidence))
        return failed("The turtle did not move.", expected, why)
    if trajectory.wall.any():
        observed = f"The turtle ran into a wall after {trajectory.wall_s:.1f} s."
        return failed(observed, expected, Cause("wall", radius_of_commands(evidence), line_of_values(evidence)))
    fitted = trajectory.circle
    if fitted is None or fitted.radius > STRAIGHT_RADIUS_M:
        hardly = trajectory.turned_rad <= TURNED_RAD
        cause = "The turtle turns too little or not at all. angular.z is the turning speed." if hardly else ""
        return failed(
            "The turtle drove in a straight line.", expected, Cause("straight-line", cause, line_of_values(evidence))
        )
    return None


def _measured(evidence: Evidence, params: CircleParams, trajectory: Trajectory, expected: str) -> Finding:
    fitted = trajectory.circle
    assert fitted is not None
    turns = trajectory.turns
    centre = math.dist((fitted.x, fitted.y), expected_centre(driven_from(evidence.recording), params))
    round_, size = Band.at_most(params.residual_m), Band.around(params.radius_m, params.radius_tolerance_m)
    place, long = Band.at_most(params.centre_tolerance_m), Band.at_least(params.turns)
    if not round_.holds(fitted.rms):
        return _not_round(evidence, trajectory, fitted, expected, near_edge=round_.near(fitted.rms))
    forward = turns if params.direction == "counter-clockwise" else -turns
    if not forward > 0.0:
        direction = "clockwise" if turns < 0.0 else "counter-clockwise"
        cause = "The sign of angular.z sets the direction: a positive value turns left, which is counter-clockwise."
        if (steady_command(evidence) or (0.0, 0.0))[0] < 0.0:
            cause = f"linear.x is negative, so the turtle drives backwards. {cause}"
        observed = f"The turtle drove the circle {direction}."
        return failed(observed, expected, Cause("wrong-direction", cause, line_of_values(evidence)))
    near = round_.near(fitted.rms) or size.near(fitted.radius) or place.near(centre) or long.near(forward)
    if not size.holds(fitted.radius):
        observed = f"The radius of the circle is {shown(round(fitted.radius, 2))} m."
        return failed(
            observed,
            expected,
            Cause("wrong-radius", why_radius(evidence), line_of_values(evidence)),
            near_edge=near,
        )
    if not place.holds(centre):
        observed = f"The circle has the right size, but it is {centre:.2f} m away from where it should be."
        return failed(observed, expected, why_elsewhere(evidence), near_edge=near)
    if not long.holds(forward):
        return _too_short(evidence, trajectory, forward, expected, near_edge=near)
    return passed(expected.replace("drives", "drove"), near_edge=near)


def _not_round(
    evidence: Evidence, trajectory: Trajectory, fitted: Circle, expected: str, *, near_edge: bool
) -> Finding:
    off = f"it deviates by {max(fitted.rms, 0.01):.2f} m (RMS) from the best-fitting circle"
    if trajectory.straight_share > POLYGON_SHARE:
        if trajectory.sides == 1:
            return failed(
                "The turtle drove in a straight line.", expected, Cause("straight-line", where=line_of_values(evidence))
            )
        observed = f"The trajectory has {trajectory.sides} straight sides with corners; {off}."
        cause = "For a circle, every command must move the turtle forward and turn it at the same time."
        return failed(observed, expected, Cause("polygon", cause, line_of_values(evidence)), near_edge=near_edge)
    changed = len({(command.linear, command.angular) for command in evidence.commands}) > 1
    cause = CHANGE if changed else ""
    return failed(
        f"The trajectory is not round: {off}.",
        expected,
        Cause("not-round", cause, line_of_values(evidence)),
        near_edge=near_edge,
    )


def _too_short(evidence: Evidence, trajectory: Trajectory, turns: float, expected: str, *, near_edge: bool) -> Finding:
    observed = f"The turtle drove {turns:.2f} turns."
    commands = all_commands(evidence)
    crash, early = crash_of(evidence), ended_early(evidence)
    last_s = commands[-1].t_s if commands else evidence.recording.end.t_s
    if stopped_by_exit(evidence, last_s, LIVES_S):
        if crash is not None:
            return crash_finding(evidence, crash, observed, expected)
        return failed(observed, expected, Cause("ended-early", early, evidence.place("publish")), near_edge=near_edge)
    if commands[0].t_s > LATE_S:
        observed = f"The turtle drove {turns:.2f} turns; the first command arrived at {commands[0].t_s:.1f} s."
        text = "A turtle that starts late has less time for the circle."
        why = Cause("late-start", text, evidence.place("sleep", "publish"))
    elif trajectory.rests:
        observed = f"The turtle drove {turns:.2f} turns, with {count(trajectory.rests, 'stop')} on the way."
        why = Cause("stops-and-goes", CHANGE if zeros_between(evidence) else NO_COMMAND)
    elif activity.end_s(evidence.recording) - commands[-1].t_s > LIVES_S:
        observed = f"The turtle drove {turns:.2f} turns; the last command arrived at {commands[-1].t_s:.1f} s."
        why = Cause("stopped-early", NO_COMMAND, cancelled(evidence, "publish"))
    else:
        speed = steady_command(evidence)
        turn_s = 2.0 * math.pi / abs(speed[1]) if speed and speed[1] else 0.0
        cause = f"With angular.z = {shown(speed[1])} rad/s, one turn takes {turn_s:.1f} s." if speed and turn_s else ""
        return failed(observed, expected, Cause("too-short", cause, line_of_values(evidence)), near_edge=near_edge)
    return failed(observed, expected, why.at(evidence.place("publish")), near_edge=near_edge)


def no_wall(evidence: Evidence, _: NoParams) -> Finding:
    """The turtle touched no wall in any frame.

    The check fails if something other than a velocity command moved the turtle. It is skipped if the turtle never
    drove, or if its position became NaN.
    """
    trajectory = evidence.trajectory
    # A turtle that is always teleported away before it reaches a wall would never touch one.
    moved = moved_otherwise(evidence, "The turtle never touches a wall.")
    if moved is not None:
        return moved
    if trajectory.wall.any():
        observed = f"The turtle ran into a wall after {trajectory.wall_s:.1f} s."
        expected = "The turtle never touches a wall."
        return failed(observed, expected, Cause("wall", radius_of_commands(evidence), line_of_values(evidence)))
    if not trajectory.finite:
        return Finding(Status.SKIPPED, "Not judged, because the turtle's position became NaN (not a number).")
    if not trajectory.length_m > MOVED_M:
        return Finding(Status.SKIPPED, "Not judged, because the turtle did not drive.")
    return passed("The turtle did not touch a wall.")


def requested_circle(evidence: Evidence, params: CircleParams) -> Requested:
    """Return the required circle, placed relative to the turtle's pose before the first command."""
    centre = expected_centre(driven_from(evidence.recording), params)
    return Requested(f"radius {params.radius_m:.2f} m", ((centre, params.radius_m),), fits=True)


CIRCLE = Kind(
    "circle",
    "trial",
    "The turtle drives the circle",
    CircleParams,
    circle,
    about="Velocity commands drive the turtle along a circle with the right shape, direction, size and place.",
    drives=True,
    requested=requested_circle,
    radius_m=lambda params: params.radius_m,
)
NO_WALL = Kind(
    "no_wall", "trial", "The turtle does not touch a wall", NoParams, no_wall, about="The turtle never touches a wall."
)
