"""The requirements of a check, in a form that can be drawn next to the recording."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.lazy import np
from grader.evidence.trajectory import RESTS_M
from grader.trial.recording import Pose

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

Point = tuple[float, float]
"""x and y (m)."""


@dataclass(frozen=True)
class Interval:
    """The time between two commands (s): the requested value and the allowed range."""

    requested_s: float
    low_s: float
    high_s: float


@dataclass(frozen=True)
class Requested:
    """The required path of the turtle: `circles` (centre and radius, m) and `lines` (points, m).

    `path` describes the path in words.

    If `fits` is True, the path is one circle, so the best-fitting circle is drawn too. `interval` is the time between
    two commands. `values` are the six values of each command (three in m/s, three in rad/s).
    """

    path: str = ""
    circles: tuple[tuple[Point, float], ...] = ()
    lines: tuple[tuple[Point, ...], ...] = ()
    fits: bool = False
    interval: Interval | None = None
    values: tuple[float, ...] | None = None


def first_heading(evidence: Evidence) -> Pose:
    """Return the turtle's start position with the heading of its first movement.

    The turtle may turn before it drives. If it never drives, or if its trajectory contains NaN or infinity, its start
    pose is returned.
    """
    start, trajectory = evidence.recording.start, evidence.trajectory
    if not trajectory.finite:
        return start
    moving = np.flatnonzero(trajectory.steps > RESTS_M)
    if not len(moving):
        return start
    at = moving[0]
    return Pose(
        start.x, start.y, math.atan2(trajectory.y[at + 1] - trajectory.y[at], trajectory.x[at + 1] - trajectory.x[at])
    )
