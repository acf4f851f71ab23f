"""Check of a figure eight: two round lobes, one to each side, that meet at the start position."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.sign_for_sum import sign_for_sum
from grader.checks.causes.too_soon import too_soon
from grader.checks.kind import Kind, choice, number
from grader.checks.outcome import Finding, failed, passed
from grader.checks.requested import Requested, first_heading
from grader.checks.starved import unless_starved
from grader.checks.subjects.path import CircleParams, expected_centre, not_driven
from grader.checks.subjects.standstill import ZEROS, no_standstill
from grader.checks.tolerance import Band
from grader.common.lazy import np
from grader.common.words import number as shown
from grader.evidence.circle_fit import Circle, fit_circle
from grader.evidence.trajectory import RESTS_M, STRAIGHT_RAD

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.evidence.trajectory import Trajectory

NAMES = ("first", "second")
SMALL_RAD = 0.3
"""A turn by a smaller angle than this (rad) does not count as a lobe."""


@dataclass(frozen=True, kw_only=True)
class Eight:
    """Requires two lobes with this radius that turn by 360 degrees each, the first lobe to the left or to the right."""

    radius_m: float = number(above=0, at_most=2.5, about="The radius of both lobes.")
    radius_tolerance_m: float = number(0.1, above=0, about="The maximum error of a radius.")
    residual_m: float = number(
        0.03, above=0, about="The maximum deviation of a lobe from its fitted circle (root mean square)."
    )
    angle_tolerance_deg: float = number(
        12.0, above=0, about="The maximum difference between the angle of a lobe and 360 degrees."
    )
    closing_m: float = number(0.2, above=0, about="The maximum distance from the start to the end of the first lobe.")
    first: str = choice("left", "right", "either", about="The side of the first lobe.")


@dataclass(frozen=True)
class Lobe:
    """A part of the trajectory that bends to one side: its angle (positive to the left), fitted circle and end (m)."""

    turned_rad: float
    circle: Circle | None
    end: tuple[float, float]

    @property
    def side(self) -> str:
        """The side to which the trajectory bends: left or right."""
        return "left" if self.turned_rad > 0.0 else "right"


def lobes_of(trajectory: Trajectory) -> list[Lobe]:
    """Return the parts in which the trajectory bends to one side by more than SMALL_RAD, in order."""
    side = np.where(
        trajectory.steps > RESTS_M, np.sign(np.where(np.abs(trajectory.turn) > STRAIGHT_RAD, trajectory.turn, 0.0)), 0.0
    )
    bends = np.flatnonzero(side)
    found: list[Lobe] = []
    for piece in np.split(bends, np.flatnonzero(np.diff(side[bends])) + 1):
        turned = float(trajectory.turn[piece].sum())
        if len(piece) and abs(turned) > SMALL_RAD:
            points = np.append(piece[0], piece + 1)
            fitted = fit_circle(trajectory.x[points], trajectory.y[points])
            found.append(Lobe(turned, fitted, (float(trajectory.x[points[-1]]), float(trajectory.y[points[-1]]))))
    return found


def eight(evidence: Evidence, params: Eight) -> Finding:
    """The turtle drives a full circle to one side, then a full circle to the other side, and then stands still."""
    expected = (
        f"The turtle drives a figure eight: a full circle of radius {shown(params.radius_m)} m to one side, then a "
        "full circle to the other side."
    )
    where = evidence.code.assigned("angular", "z") or evidence.place("Twist", "publish")
    trajectory = evidence.trajectory
    still = not_driven(evidence, expected, where)
    if still is not None:
        return still
    if trajectory.wall.any():
        return failed("The turtle ran into a wall.", expected, Cause("wall", _why_wall(evidence, params), where))
    lobes = lobes_of(trajectory)
    if len(lobes) < 2:
        what = f"only one lobe, to the {lobes[0].side}" if lobes else "no lobe"
        text = "When the first lobe is closed, the sign of angular.z must change for the second one."
        one = sign_for_sum(evidence, "one-lobe") or Cause("one-lobe", text, where)
        return failed(f"The trajectory has {what}.", expected, one)
    if params.first not in (lobes[0].side, "either"):
        observed = f"The first lobe goes to the {lobes[0].side}."
        cause = "A positive angular.z turns the turtle to the left."
        return failed(observed, f"The first lobe goes to the {params.first}.", Cause("wrong-side-first", cause, where))
    near = False
    first, second = (
        _lobe(evidence, params, name, lobe, last=name == NAMES[-1]) for name, lobe in zip(NAMES, lobes, strict=False)
    )
    for finding, is_near in (first, second):
        near |= is_near
        if finding is not None:
            open_ = finding.diagnosis == "lobe-angle" and abs(lobes[0].turned_rad) < math.tau
            return too_soon(finding, evidence) if open_ and second[0] is None else finding
    further = _drives_on(evidence, lobes, expected)
    if further is not None:
        return further
    return passed(f"The turtle drove a figure eight with radius {shown(params.radius_m)} m.", near_edge=near)


def _why_wall(evidence: Evidence, params: Eight) -> str:
    """Return a sentence that explains why the turtle drove into the wall, or an empty string."""
    at = int(evidence.trajectory.wall.argmax())
    linear, angular = (
        float(speed[at]) for speed in (evidence.recording.frames.linear, evidence.recording.frames.angular)
    )
    if abs(angular) <= STRAIGHT_RAD:
        return "The turtle drove straight into the wall. angular.z is the turning speed."
    too_large = abs(linear / angular) > params.radius_m + params.radius_tolerance_m
    return "The lobes are too large." if too_large else ""


def _lobe(evidence: Evidence, params: Eight, name: str, lobe: Lobe, *, last: bool) -> tuple[Finding | None, bool]:
    """Return a failed finding for a wrong lobe (else None), and whether a value is near an edge of its tolerance."""
    where = evidence.code.assigned("angular", "z") or evidence.place("Twist", "publish")
    recording = evidence.recording
    subject = f"The {name} lobe, to the {lobe.side},"
    wanted = f"Both lobes have a radius of {shown(params.radius_m)} m and turn by 360 degrees."
    round_ = Band.at_most(params.residual_m)
    if lobe.circle is None or not round_.holds(lobe.circle.rms):
        off = lobe.circle.rms if lobe.circle is not None else math.inf
        observed = f"{subject} is not round: it deviates by {off:.2f} m from the best-fitting circle."
        cause = "All commands within one lobe must be the same."
        return failed(observed, wanted, Cause("lobe-not-round", cause, where)), False
    size = Band.around(params.radius_m, params.radius_tolerance_m)
    radius = lobe.circle.radius
    near = size.near(radius) or round_.near(lobe.circle.rms)
    if not size.holds(radius):
        more = radius - params.radius_m
        observed = (
            f"{subject} has a radius of {radius:.2f} m: {abs(more):.2f} m too {'large' if more > 0 else 'small'}."
        )
        cause = "The radius is linear.x divided by angular.z."
        return failed(observed, wanted, Cause("lobe-radius", cause, where), near_edge=near), near
    degrees = abs(math.degrees(lobe.turned_rad))
    full = Band.around(360.0, params.angle_tolerance_deg)
    near |= full.near(degrees)
    if not full.holds(degrees):
        if degrees < 360.0:
            observed = f"{subject} is not closed: it ends {360.0 - degrees:.0f} degrees too early."
        else:
            observed = f"{subject} continues for {degrees - 360.0:.0f} degrees after it was closed."
        cause = "A full circle takes 2 pi / abs(angular.z) seconds. How many timer calls does a full circle take?"
        if last and degrees > 360.0:
            cause = f"After the second lobe, the turtle must stand still. {ZEROS}"
        if full.holds(math.radians(degrees)):
            cause = "angular.z is in radians per second, and a full circle is 2 pi radians, not 360."
        finding = failed(observed, wanted, Cause("lobe-angle", cause, evidence.place("create_timer")), near_edge=near)
        turning = math.degrees(float(np.abs(recording.frames.angular).max()))
        return unless_starved(finding, recording, abs(degrees - 360.0) - params.angle_tolerance_deg, turning), near
    start = (evidence.recording.start.x, evidence.recording.start.y)
    gap = math.dist(lobe.end, start)
    meets = Band.at_most(params.closing_m)
    if not last and not meets.holds(gap):
        observed = f"{subject} ends {gap:.2f} m away from the start position."
        finding = failed(
            observed, "Both lobes meet at the start position.", Cause("lobe-gap", where=where), near_edge=True
        )
        speed = float(recording.frames.linear.max())
        return unless_starved(finding, recording, gap - params.closing_m, speed), near
    return None, near


def _drives_on(evidence: Evidence, lobes: list[Lobe], expected: str) -> Finding | None:
    """Return a failed finding if the turtle does not stand still after the second lobe, else None."""
    if len(lobes) > len(NAMES):
        observed = f"After the second lobe, the turtle drives a third one, to the {lobes[len(NAMES)].side}."
        cause = f"After two lobes, the turtle must stand still. {ZEROS}"
        return failed(observed, expected, Cause("drives-on", cause, evidence.place("publish")))
    return no_standstill(evidence, expected)


def requested_eight(evidence: Evidence, params: Eight) -> Requested:
    """Return two circles, one to the left and one to the right of the turtle's first movement."""
    begin = first_heading(evidence)
    directions = ("counter-clockwise", "clockwise")
    sides = [CircleParams(radius_m=params.radius_m, direction=direction) for direction in directions]
    circles = tuple((expected_centre(begin, side), params.radius_m) for side in sides)
    return Requested(f"two lobes, radius {params.radius_m:.2f} m", circles)


EIGHT = Kind(
    "figure_eight",
    "trial",
    "The turtle drives a figure eight",
    Eight,
    eight,
    about="The turtle drives two round lobes of the same size, one to each side, which meet at the start position. "
    "Then the turtle stands still.",
    drives=True,
    requested=requested_eight,
    radius_m=lambda params: params.radius_m,
)
