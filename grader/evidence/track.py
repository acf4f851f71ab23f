"""Track: the turtle's way while it was commanded, from the simulator's frames."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from grader.common.lazy import np
from grader.evidence import observed
from grader.evidence.circle_fit import Circle, fit_circle, turns_about

if TYPE_CHECKING:
    from grader.trial.recording import Floats, Recording

RESTS_M = 1e-9
"""A frame in which the turtle gets no further than this is one of rest."""
STRAIGHT_RAD = 1e-9
"""A step that turns by no more than this is straight."""


@dataclass(frozen=True)
class Track:
    """The way until SIGINT: `x`, `y` (m) of shape (N + 1,), the start first; the others of shape (N,), one a frame.

    `t_s` (s), `turn` by how much the heading changed (rad), `wall` where the frame was clamped.
    """

    x: Floats
    y: Floats
    t_s: Floats
    turn: Floats
    wall: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]

    @cached_property
    def finite(self) -> bool:
        """No NaN and no infinity."""
        return bool(np.isfinite(self.x).all() and np.isfinite(self.y).all() and np.isfinite(self.turn).all())

    @cached_property
    def steps(self) -> Floats:
        """Length of each step (m)."""
        return np.hypot(np.diff(self.x), np.diff(self.y))

    @property
    def length_m(self) -> float:
        """Length of the whole way."""
        return float(self.steps.sum())

    @property
    def turned_rad(self) -> float:
        """How much the heading turned, both ways counted."""
        return float(np.abs(self.turn).sum())

    @cached_property
    def points(self) -> tuple[Floats, Floats]:
        """The corners of the way, x and y (m), rests left out."""
        moving = np.flatnonzero(self.steps > RESTS_M)
        if not len(moving):
            return self.x[:0], self.y[:0]
        ends = moving + 1
        return np.append(self.x[moving[0]], self.x[ends]), np.append(self.y[moving[0]], self.y[ends])

    @cached_property
    def circle(self) -> Circle | None:
        """The circle fitted to the corners; None for a straight way."""
        return fit_circle(*self.points)

    @property
    def turns(self) -> float:
        """Turns about the centre of the fitted circle, counter-clockwise positive; 0 without one."""
        return 0.0 if self.circle is None else turns_about(*self.points, self.circle.x, self.circle.y)

    @property
    def straight_share(self) -> float:
        """Which part of the way was driven without turning, 0 to 1."""
        return (
            float(self.steps[np.abs(self.turn) <= STRAIGHT_RAD].sum()) / self.length_m if self.length_m > 0.0 else 0.0
        )

    @property
    def sides(self) -> int:
        """How many straight pieces the way has, one counted as ended by a turn."""
        moves = self.steps > RESTS_M
        straight = moves & (np.abs(self.turn) <= STRAIGHT_RAD)
        turned = np.cumsum(np.abs(self.turn) > STRAIGHT_RAD)
        return len(np.unique(turned[straight]))

    @property
    def rests(self) -> int:
        """How often the turtle stopped and went on again."""
        moves = (self.steps > RESTS_M) | (np.abs(self.turn) > STRAIGHT_RAD)
        busy = np.flatnonzero(moves)
        return int((np.diff(busy) > 1).sum()) if len(busy) else 0


def track_of(recording: Recording) -> Track:
    """The turtle's way from its start until SIGINT."""
    frames = recording.frames
    until = frames.t_s <= observed.end_s(recording)
    x = np.append(recording.start.x, frames.x[until])
    y = np.append(recording.start.y, frames.y[until])
    with np.errstate(invalid="ignore"):  # NaN and infinity are looked for by `finite`
        heading = np.append(recording.start.theta, frames.theta[until])
        turn = np.mod(np.diff(heading) + np.pi, 2.0 * np.pi) - np.pi
        return Track(x, y, frames.t_s[until], turn, frames.wall[until])
