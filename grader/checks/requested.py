"""Requested: what a check asks of the node, so far as it can be drawn beside what was observed."""

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
    """The time between two commands (s): as requested, and from `low` to `high` at most."""

    requested_s: float
    low_s: float
    high_s: float


@dataclass(frozen=True)
class Requested:
    """The path of the turtle as `circles` (centre, radius in m) and `lines` (m); `path` says in words what it is.

    `fits`: the path is one circle, so the circle that fits best belongs beside it. `interval` is that between two
    commands, `values` are the six of each command (m/s three times, rad/s three times).
    """

    path: str = ""
    circles: tuple[tuple[Point, float], ...] = ()
    lines: tuple[tuple[Point, ...], ...] = ()
    fits: bool = False
    interval: Interval | None = None
    values: tuple[float, ...] | None = None


def first_heading(evidence: Evidence) -> Pose:
    """Where the turtle starts, looking in the direction in which it first drives: it may have turned before."""
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
