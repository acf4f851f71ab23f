"""Trajectory: the path of the turtle, from the frames of the simulator."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from grader.common.lazy import np
from grader.evidence import activity
from grader.evidence.circle_fit import Circle, fit_circle, turns_about
from grader.evidence.interventions import MOVING, first_driven
from grader.trial.recording import OUTLIVES_S, Pose

if TYPE_CHECKING:
    from grader.trial.recording import Floats, Recording

RESTS_M = 1e-9
"""A turtle that moves at most this far in a frame is at rest (m)."""
STRAIGHT_RAD = 1e-9
"""A step that turns by at most this angle counts as straight (rad)."""


@dataclass(frozen=True)
class Trajectory:
    """A trajectory of the turtle, with one step per frame. `trajectory_of` creates it from a recording.

    `x` and `y` (m) have the shape (N + 1,) and begin with the start position. The other arrays have the shape (N,):
    `t_s` is the time (s), `turn` is the change of the heading (rad), and `wall` is true if the simulator had to keep
    the turtle inside the canvas.
    """

    x: Floats
    y: Floats
    t_s: Floats
    turn: Floats
    wall: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]

    @cached_property
    def finite(self) -> bool:
        """Whether all values are finite: no NaN and no infinity."""
        return bool(np.isfinite(self.x).all() and np.isfinite(self.y).all() and np.isfinite(self.turn).all())

    @cached_property
    def steps(self) -> Floats:
        """The distance between each pair of successive points (m)."""
        return np.hypot(np.diff(self.x), np.diff(self.y))

    @property
    def length_m(self) -> float:
        """The length of the trajectory (m)."""
        return float(self.steps.sum())

    @property
    def turned_rad(self) -> float:
        """The sum of all turns to the left and to the right (rad)."""
        return float(np.abs(self.turn).sum())

    @property
    def wall_s(self) -> float:
        """The time at which the turtle first touched a wall (s). Use this only if the turtle touched a wall."""
        return float(self.t_s[int(self.wall.argmax())])

    @cached_property
    def points(self) -> tuple[Floats, Floats]:
        """The points of the trajectory, x and y (m), without the frames in which the turtle is at rest."""
        moving = np.flatnonzero(self.steps > RESTS_M)
        if not len(moving):
            return self.x[:0], self.y[:0]
        ends = moving + 1
        return np.append(self.x[moving[0]], self.x[ends]), np.append(self.y[moving[0]], self.y[ends])

    @cached_property
    def circle(self) -> Circle | None:
        """The circle that fits the points best, or None if there is no such circle, as for a straight trajectory."""
        return fit_circle(*self.points)

    @property
    def turns(self) -> float:
        """The number of turns about the centre of the fitted circle, positive if counter-clockwise.

        If there is no circle, the number is 0.
        """
        return 0.0 if self.circle is None else turns_about(*self.points, self.circle.x, self.circle.y)

    @property
    def straight_share(self) -> float:
        """The share of the trajectory that was driven without turning, from 0 to 1."""
        return (
            float(self.steps[np.abs(self.turn) <= STRAIGHT_RAD].sum()) / self.length_m if self.length_m > 0.0 else 0.0
        )

    @property
    def sides(self) -> int:
        """The number of straight pieces. Any turn ends a straight piece, but a stop does not."""
        moves = self.steps > RESTS_M
        straight = moves & (np.abs(self.turn) <= STRAIGHT_RAD)
        turned = np.cumsum(np.abs(self.turn) > STRAIGHT_RAD)
        return len(np.unique(turned[straight]))

    @property
    def rests(self) -> int:
        """The number of times that the turtle stopped, and then moved or turned again."""
        moves = (self.steps > RESTS_M) | (np.abs(self.turn) > STRAIGHT_RAD)
        busy = np.flatnonzero(moves)
        return int((np.diff(busy) > 1).sum()) if len(busy) else 0


def driven_from(recording: Recording) -> Pose:
    """Return the pose of the turtle before the first command.

    If this pose is not the start pose, a service call or a goal of the submission has moved the turtle.
    """
    before, frames = _before_driving(recording), recording.frames
    if not before:
        return recording.start
    return Pose(float(frames.x[before - 1]), float(frames.y[before - 1]), float(frames.theta[before - 1]))


def _before_driving(recording: Recording) -> int:
    """Return the number of frames before the first command, or 0 if no call can have moved the turtle by then."""
    return first_driven(recording) if MOVING & set(recording.interventions) else 0


def trajectory_of(recording: Recording) -> Trajectory:
    """Return the trajectory of the turtle from the pose before the first command (`driven_from`) until SIGINT.

    If the node exited on its own, the trajectory ends OUTLIVES_S (s) after the exit.
    """
    frames, start = recording.frames, driven_from(recording)
    by_itself = recording.end.by == "itself"
    until = frames.t_s <= (recording.end.t_s + OUTLIVES_S if by_itself else activity.end_s(recording))
    until[: _before_driving(recording)] = False
    x = np.append(start.x, frames.x[until])
    y = np.append(start.y, frames.y[until])
    with np.errstate(invalid="ignore"):  # `finite` checks for NaN and infinity
        heading = np.append(start.theta, frames.theta[until])
        turn = np.mod(np.diff(heading) + np.pi, 2.0 * np.pi) - np.pi
        return Trajectory(x, y, frames.t_s[until], turn, frames.wall[until])
