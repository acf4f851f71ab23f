"""Check of a drive to a goal: the turtle turns towards the goal the short way round."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.kind import Kind, number
from grader.checks.outcome import Finding, failed, passed
from grader.checks.tolerance import Band
from grader.common.lazy import np
from grader.common.words import count

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

NEAR_M = 0.5
"""Within this distance (m) of the goal, the direction to the goal changes quickly, so turns no longer count."""
EITHER_RAD = 0.2
"""If the goal is straight behind the turtle, up to this angle (rad), both ways round are equally short."""


@dataclass(frozen=True, kw_only=True)
class ShortTurn:
    """The position of the goal (m), and the largest allowed turn (rad) away from the goal."""

    x_m: float = number(about="The x coordinate of the goal.")
    y_m: float = number(about="The y coordinate of the goal.")
    most_rad: float = number(
        2.0,
        above=math.pi / 2,
        about="The maximum turn in the wrong direction. A turtle that drives backwards turns up to a quarter turn.",
    )


def short_turn(evidence: Evidence, params: ShortTurn) -> Finding:
    """Until the turtle is near the goal, it does not turn the long way round."""
    trajectory = evidence.trajectory
    start = evidence.recording.start
    error = math.atan2(params.y_m - start.y, params.x_m - start.x) - start.theta
    error = math.atan2(math.sin(error), math.cos(error))
    side, other = ("left", "right") if error > 0 else ("right", "left")
    expected = "The turtle turns towards the goal the short way round."
    near = np.flatnonzero(np.hypot(trajectory.x - params.x_m, trajectory.y - params.y_m) <= NEAR_M)
    turned = np.cumsum(trajectory.turn[: near[0] if len(near) else None])
    wrong = float(np.max(turned * -math.copysign(1.0, error), initial=0.0))
    most = Band.at_most(params.most_rad)
    if most.holds(wrong) or math.pi - abs(error) <= EITHER_RAD:
        return passed("The turtle turned towards the goal the short way round.", near_edge=most.near(wrong))
    observed = (
        f"At the start, the goal was {count(round(math.degrees(abs(error))), 'degree')} to the {side}, but the turtle "
        f"turned by {math.degrees(wrong):.0f} degrees to the {other}."
    )
    text = "Bring the error into the range from -pi to pi, with atan2(sin(error), cos(error))."
    where = evidence.code.assigned("angular", "z") or evidence.place("publish")
    return failed(observed, expected, Cause("long-way-round", text, where), near_edge=most.near(wrong))


SHORT_TURN = Kind(
    "short_turn",
    "trial",
    "The turtle turns the short way round",
    ShortTurn,
    short_turn,
    about="Until the turtle is near the goal, it does not turn the long way round. The check means something only if "
    "`start_pose` has a heading near pi or -pi, and the goal is on the other side of this angle.",
)
