"""Check of an arc: a part of the trajectory, drawn in a certain colour or driven at a certain time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.sign_for_sum import sign_for_sum
from grader.checks.causes.waiting import SLEEPS, waits_in_callbacks
from grader.checks.causes.why_blocked import why_blocked
from grader.checks.causes.why_condition import stored_before_refused
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_path import radius_of_commands
from grader.checks.kind import Kind, choice, number
from grader.checks.outcome import Finding, failed, passed
from grader.checks.subjects.parameters import set_calls, was_accepted
from grader.checks.subjects.path import STRAIGHT_RADIUS_M, moved_otherwise, not_finite
from grader.checks.tolerance import Band
from grader.common.lazy import np
from grader.evidence.circle_fit import fit_circle, turns_about
from grader.evidence.pens import pen_spans
from grader.evidence.trajectory import RESTS_M
from grader.turtlesim.turtle import FRAME_S

if TYPE_CHECKING:
    import numpy.typing as npt

    from grader.evidence.evidence import Evidence

    Steps = npt.NDArray[np.bool_]

SHORT_M = 0.05
"""A piece of the trajectory that is shorter than this (m) is not an arc."""
FEW = 5
SAME_ARC = 0.02
"""Two frames belong to the same arc if the turtle's turns per metre differ by at most this fraction."""
MOST_ROOM_M = 2.5
"""There is always a random start position with room for a circle of this radius (m) on both sides."""


@dataclass(frozen=True, kw_only=True)
class Arc:
    """An arc of a circle. If `red` is not negative, only the parts that were drawn in the given colour count."""

    radius_m: float = number(above=0, at_most=5.5, about="The radius of the arc.")
    radius_tolerance_m: float = number(0.06, above=0, about="The maximum error in the radius.")
    residual_m: float = number(0.03, above=0, about="The maximum deviation of the arc from the fitted circle (RMS).")
    direction: str = choice("counter-clockwise", "clockwise", about="The direction of the turn.")
    angle_deg: float = number(0.0, at_least=0, about="The angle of the arc; 0 allows any angle.")
    angle_tolerance_deg: float = number(12.0, above=0, about="The maximum error in the angle.")
    speed_m_s: float = number(0.0, at_least=0, about="The speed of the turtle; 0 allows any speed.")
    speed_tolerance_m_s: float = number(0.05, above=0, about="The maximum error in the speed.")
    from_s: float = number(0.0, at_least=0, about="Only the movement after this time counts.")
    until_s: float = number(600.0, above=0, about="Only the movement before this time counts.")
    red: float = number(
        -1.0,
        at_least=-1,
        at_most=255,
        about="The red component of the pen's colour. Without this key, any colour is accepted.",
    )
    green: float = number(-1.0, at_least=-1, at_most=255, about="The green component of the pen's colour.")
    blue: float = number(-1.0, at_least=-1, at_most=255, about="The blue component of the pen's colour.")

    @property
    def color(self) -> tuple[int, int, int] | None:
        """The colour of the pen, or None for any colour."""
        return None if self.red < 0 else (round(self.red), round(self.green), round(self.blue))


def arc(evidence: Evidence, params: Arc) -> Finding:
    """The examined piece of the trajectory is an arc with the right radius, direction, angle and speed."""
    expected = _expected(params)
    moved = moved_otherwise(evidence, expected) or not_finite(evidence, expected)
    if moved is not None:
        return moved
    trajectory = evidence.trajectory
    chosen = _chosen(evidence, params)
    length = float(trajectory.steps[chosen].sum())
    if not (length > SHORT_M and int(chosen.sum()) >= FEW):
        return _nothing(evidence, params, chosen, expected)
    return _measured(evidence, params, chosen, expected)


def _measured(evidence: Evidence, params: Arc, chosen: Steps, expected: str) -> Finding:
    trajectory = evidence.trajectory
    where = evidence.code.assigned("angular", "z") or evidence.place("Twist", "publish")
    if params.color is not None and _pieces(evidence, chosen) > 1:
        color = ", ".join(map(str, params.color))
        other = "with another colour" if _always_draws(evidence) else "without this colour"
        observed = f"The turtle drew with the colour {color}, then {other}, and then with the first colour again."
        text = "Does the node start again after its last arc? In its last state, the node must send only zeros."
        return failed(observed, expected, Cause("drives-on", text, evidence.place("publish")))
    points = np.append(np.flatnonzero(chosen)[0], np.flatnonzero(chosen) + 1)
    x, y = trajectory.x[points], trajectory.y[points]
    fitted = fit_circle(x, y)
    if fitted is None or fitted.radius > STRAIGHT_RADIUS_M:
        return failed("The turtle drove in a straight line.", expected, Cause("straight-line", where=where))
    round_, size = Band.at_most(params.residual_m), Band.around(params.radius_m, params.radius_tolerance_m)
    touched = np.flatnonzero(chosen & trajectory.wall)
    if not round_.holds(fitted.rms) and len(touched):
        observed = f"The turtle ran into a wall after {trajectory.t_s[touched[0]]:.1f} s."
        return failed(observed, expected, Cause("wall", radius_of_commands(evidence), where))
    if not round_.holds(fitted.rms):
        off = f"it deviates by {max(fitted.rms, 0.01):.2f} m (RMS) from the best-fitting circle"
        text = "The command or the pen changes during this part of the path."
        stored = stored_before_refused(evidence) if _was_refused(evidence, params) else None
        cause = stored or Cause("not-round", text, where)
        return failed(
            f"This part of the path is not a single arc: {off}.", expected, cause, near_edge=round_.near(fitted.rms)
        )
    near = round_.near(fitted.rms) or size.near(fitted.radius)
    if not size.holds(fitted.radius):
        text = "The radius is linear.x divided by angular.z."
        cause = _not_followed(evidence, params) or _slept(evidence) or Cause("wrong-radius", text, where)
        return failed(f"The radius of this arc is {fitted.radius:.2f} m.", expected, cause, near_edge=near)
    turns = turns_about(x, y, fitted.x, fitted.y)
    if (turns > 0.0) != (params.direction == "counter-clockwise"):
        observed = f"The turtle drove this arc {'counter-clockwise' if turns > 0.0 else 'clockwise'}."
        text = "The sign of angular.z sets the direction: a positive value turns left, which is counter-clockwise."
        return failed(observed, expected, Cause("wrong-direction", text, where))
    angle, speed = abs(turns) * 360.0, _speed(evidence, chosen)
    wide, pace = (
        Band.around(params.angle_deg, params.angle_tolerance_deg) if params.angle_deg else Band(None, None),
        Band.around(params.speed_m_s, params.speed_tolerance_m_s) if params.speed_m_s else Band(None, None),
    )
    near = near or wide.near(angle) or pace.near(speed)
    if not wide.holds(angle):
        crash = crash_of(evidence)
        if crash is not None and _until_the_end(chosen):
            return crash_finding(evidence, crash, end_observed(evidence), expected)
        observed, cause = _other_angle(evidence, params, chosen, angle)
        return failed(observed, expected, cause, near_edge=near)
    if not pace.holds(speed):
        cause = _not_followed(evidence, params) or _slept(evidence) or Cause("wrong-speed", where=where)
        return failed(f"The turtle drove this arc at {speed:.2f} m/s.", expected, cause, near_edge=near)
    return passed(f"The turtle drove an arc of radius {fitted.radius:.2f} m.", near_edge=near)


def _other_angle(evidence: Evidence, params: Arc, chosen: Steps, angle: float) -> tuple[str, Cause]:
    """Return the observation and the cause for an arc with the wrong angle (degrees)."""
    too_long = angle > params.angle_deg
    if too_long and _until_the_end(chosen):
        observed = f"This arc has an angle of {angle:.0f} degrees, and the turtle was still driving it at the end."
        text = "The state must change after the last timer call of this arc. At which value does the counter start?"
        return observed, sign_for_sum(evidence, "drives-on") or Cause("drives-on", text, evidence.place("publish"))
    sides = _goes_on(evidence, chosen) if params.color is not None and _always_draws(evidence) else (False, False)
    if not too_long and any(sides):
        text = "The pen must have this colour before the turtle moves: wait for the response before you drive."
        if not sides[0]:
            text = "The pen changed before the end of this arc. Ask for the next pen when the arc is complete."
        cause = Cause("not-in-colour", text, evidence.place("publish"))
        return "A part of this arc was drawn in a different colour.", cause
    where = evidence.code.assigned("angular", "z") or evidence.place("Twist", "publish")
    text = "The angle is angular.z times the time, which is the number of timer calls times the timer period."
    return f"This arc has an angle of {angle:.0f} degrees.", Cause("wrong-angle", text, where)


def _until_the_end(chosen: Steps) -> bool:
    """Return whether the arc includes the last step of the trajectory."""
    return bool(chosen[-1])


def _was_refused(evidence: Evidence, params: Arc) -> bool:
    """Return whether the node refused a value of a parameter before this arc."""
    calls = [call for call in set_calls(evidence) if call.t_s < params.from_s]
    return any(call.response is not None and not was_accepted(call) for call in calls)


def _not_followed(evidence: Evidence, params: Arc) -> Cause | None:
    """Return the cause if the node accepted a new parameter value but did not change its commands, else None."""
    changes = [call.t_s for call in set_calls(evidence) if was_accepted(call)]
    accepted = [t_s for t_s in changes if t_s < params.from_s]
    if not accepted:
        return None
    # The next change can come in the last frame of the arc.
    until_s = min([params.until_s, *(t_s - FRAME_S for t_s in changes if t_s >= params.from_s)])
    before = [each for each in evidence.commands if each.t_s < accepted[-1] - FRAME_S]
    after = [each for each in evidence.commands if params.from_s <= each.t_s <= until_s]
    same = [(each.linear, each.angular) == (before[-1].linear, before[-1].angular) for each in after if before]
    if not (same and all(same)):
        return None
    text = (
        "The parameter was set, but the commands did not change. Read the parameter with get_parameter before each "
        "command."
    )
    return Cause("parameter-not-followed", text, evidence.place("get_parameter"))


def _slept(evidence: Evidence) -> Cause | None:
    """Return the cause if a callback of a node whose parameters are set sleeps, so commands come late, else None."""
    sleeps = (wait.cause for wait in waits_in_callbacks(evidence) if wait.name in SLEEPS)
    return next(sleeps, None) if set_calls(evidence) else None


def _expected(params: Arc) -> str:
    angle = f" of {params.angle_deg:g} degrees" if params.angle_deg else ""
    speed = f" at {params.speed_m_s:g} m/s" if params.speed_m_s else ""
    color = f", drawn in the colour {', '.join(map(str, params.color))}" if params.color else ""
    return f"The turtle drives an arc{angle} with a radius of {params.radius_m:g} m, {params.direction}{speed}{color}."


def _chosen(evidence: Evidence, params: Arc) -> Steps:
    """Return a boolean array that is True for each step of the trajectory that belongs to the arc."""
    trajectory = evidence.trajectory
    chosen = (trajectory.steps > RESTS_M) & (trajectory.t_s > params.from_s) & (trajectory.t_s <= params.until_s)
    if params.color is None:
        return chosen
    drawn = np.zeros(len(trajectory.t_s), dtype=np.bool_)
    for span in pen_spans(evidence.recording):
        if span.pen.down and span.pen.color == params.color:
            drawn |= (trajectory.t_s >= span.from_s) & (trajectory.t_s < span.until_s)
    return chosen & drawn


def _pieces(evidence: Evidence, chosen: Steps) -> int:
    """Return the number of pieces into which other movements of the turtle divide the chosen steps."""
    moves = evidence.trajectory.steps > RESTS_M
    return int((np.diff(np.flatnonzero(chosen[moves])) > 1).sum()) + 1


def _goes_on(evidence: Evidence, chosen: Steps) -> tuple[bool, bool]:
    """Return whether the arc continues in the frame before the chosen steps, and whether in the frame after them.

    The frame belongs to the same arc if the turtle turned by the same angle per metre.
    """
    trajectory, ends = evidence.trajectory, np.flatnonzero(chosen)
    turn_per_m = np.median(trajectory.turn[chosen] / trajectory.steps[chosen])
    off = np.abs(trajectory.turn - turn_per_m * trajectory.steps)
    same = (trajectory.steps > RESTS_M) & (off <= SAME_ARC * np.abs(turn_per_m) * trajectory.steps)
    before, after = int(ends[0]) - 1, int(ends[-1]) + 1
    return before >= 0 and bool(same[before]), after < len(same) and bool(same[after])


def _always_draws(evidence: Evidence) -> bool:
    """Return whether the pen of the turtle is down all the time."""
    return all(span.pen.down for span in pen_spans(evidence.recording))


def _nothing(evidence: Evidence, params: Arc, chosen: Steps, expected: str) -> Finding:
    where = evidence.place("publish")
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    if params.color is not None and evidence.trajectory.length_m > SHORT_M:
        text = "The pen must have this colour before the turtle moves: wait for the response before you drive."
        color = ", ".join(map(str, params.color))
        amount = "Almost nothing" if chosen.any() else "Nothing"
        return failed(f"{amount} was drawn in the colour {color}.", expected, Cause("not-in-colour", text, where))
    cause = why_blocked(evidence) or Cause("not-moving", where=where)
    drove = "hardly drove" if chosen.any() else "did not drive"
    return failed(f"The turtle {drove} in the time that this check judges.", expected, cause)


def _speed(evidence: Evidence, chosen: Steps) -> float:
    """Return the median speed (m/s) of these steps of the trajectory."""
    return float(np.median(evidence.trajectory.steps[chosen])) / FRAME_S


ARC = Kind(
    "arc",
    "trial",
    "The turtle drives an arc",
    Arc,
    arc,
    about="Velocity commands drive the turtle along an arc, in a certain colour or in a certain part of the trial.",
    drives=True,
    # A second arc, to the other side, leaves the circle of the first one, but stays within twice its radius.
    radius_m=lambda params: max(params.radius_m, min(2.0 * params.radius_m, MOST_ROOM_M)),
)
