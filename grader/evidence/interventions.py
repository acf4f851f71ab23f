"""Find out from the movement itself whether something other than velocity commands moved the turtle.

In each frame, turtlesim moves a turtle only according to its velocities, and keeps it inside the walls. In three cases,
something else (a teleport, a reset or a goal of rotate_absolute) moved the turtle: a movement does not follow from the
velocities, the turtle turned while a goal was active, or it turned at a speed that no recent command had set.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.lazy import np
from grader.evidence import activity
from grader.trial.observed import MOST_GOALS
from grader.turtlesim.turtle import FRAME_S, SIDE_M

if TYPE_CHECKING:
    import numpy.typing as npt

    from grader.trial.recording import Floats, Recording

    Steps = npt.NDArray[np.bool_]

RESET = "reset"
MOVING = frozenset({RESET, "teleport_absolute", "teleport_relative", "rotate_absolute"})
"""Calls that may move a turtle. Such a call has no effect if the turtle is already at the destination."""
KILL = "kill"
ALWAYS = frozenset({KILL, "set_parameters"})
"""Calls that remove a turtle or may change its response to commands."""
ROTATE = "/turtle1/rotate_absolute"
SAME = 1e-5
"""The largest difference (m, rad, rad/s) that counts as zero."""
KEPT_S = 1.1
"""The maximum time for which a command has an effect (s). turtlesim stops a turtle 1 s after the last command."""


def moved_by(recording: Recording, *, from_start: bool, others_removed: bool = False) -> str | None:
    """Return the first call that may have moved the turtle, or None if velocity commands explain all movements.

    Without `others_removed`, a call that removes a turtle or sets a parameter always counts. With `others_removed`, the
    node may make such calls, but it must not remove turtle1 and spawn it at another place. With `from_start`, movements
    since the start of the trial count. Without it, only movements after the first command count.
    """
    always = next((name for name in recording.interventions if name in ALWAYS and not others_removed), None)
    if always is not None:
        return always
    first = 0 if from_start else first_driven(recording)
    names = [name for name in recording.interventions if name in MOVING]
    if names and _moved(recording, first):
        return names[0]
    return KILL if KILL in recording.interventions and _jumped(recording, first) else None


def first_driven(recording: Recording) -> int:
    """Return the index of the first frame in which a command could have moved the turtle."""
    begin_s = min((command.t_s for command in recording.commands), default=0.0)
    return int(np.searchsorted(recording.frames.t_s, begin_s))


def _moved(recording: Recording, first: int) -> bool:
    """Return whether a frame from number `first` on has a movement that the velocities or commands do not explain."""
    path = _path(recording, first)
    linear = recording.frames.linear[path.frames]
    unlike = ~(_driven(path, linear) | _driven(path, -linear)) | path.turned_otherwise
    return bool((unlike | _unasked(recording, path.frames) | _by_goal(recording, path.frames)).any())


def _jumped(recording: Recording, first: int) -> bool:
    """Return whether, in a frame from number `first` on, the turtle moved or turned more than its velocities allow."""
    path = _path(recording, first)
    far = np.hypot(np.diff(path.x), np.diff(path.y)) - np.abs(recording.frames.linear[path.frames]) * FRAME_S
    return bool((~(far <= SAME) | path.turned_otherwise).any())


@dataclass(frozen=True)
class _Path:
    """A part of a trajectory: some successive frames.

    `x`, `y` (m) and `theta` (rad) begin with the values before the first of these frames. `turned_otherwise` is true
    for the frames in which the turtle did not turn by the angle that follows from its angular velocity.
    """

    frames: slice
    x: Floats
    y: Floats
    theta: Floats
    turned_otherwise: Steps


def _path(recording: Recording, first: int) -> _Path:
    """Return the path from frame number `first` until the end of the scenario."""
    frames = recording.frames
    stop = int(np.searchsorted(frames.t_s, activity.end_s(recording), side="right"))
    x, y, theta = (
        values[first - 1 : stop] if first else np.append(start, values[:stop])
        for values, start in (
            (frames.x, recording.start.x),
            (frames.y, recording.start.y),
            (frames.theta, recording.start.theta),
        )
    )
    turn = np.mod(np.diff(theta) - frames.angular[first:stop] * FRAME_S + np.pi, 2.0 * np.pi) - np.pi
    return _Path(slice(first, stop), x, y, theta, ~(np.abs(turn) <= SAME))


def _driven(path: _Path, speed: Floats) -> Steps:
    """Return a mask of the frames in which the turtle moved forward at this speed (m/s), or as far as a wall."""
    cos, sin = np.cos(path.theta[1:]), np.sin(path.theta[1:])
    x = np.clip(path.x[:-1] + cos * speed * FRAME_S, 0.0, SIDE_M)
    y = np.clip(path.y[:-1] + sin * speed * FRAME_S, 0.0, SIDE_M)
    driven: Steps = (np.abs(x - path.x[1:]) <= SAME) & (np.abs(y - path.y[1:]) <= SAME)
    return driven


def _by_goal(recording: Recording, now: slice) -> Steps:
    """Return a mask of the frames in which the turtle turned while it followed a goal."""
    t_s, angular = recording.frames.t_s[now], recording.frames.angular[now]
    # After so many goals, further goals are not in the recording.
    follows = np.full(len(t_s), len(recording.goals) >= MOST_GOALS)
    for goal in recording.goals:
        if goal.action == ROTATE:
            follows |= (t_s > goal.t_s) & (t_s <= (np.inf if goal.ended_s is None else goal.ended_s))
    turns: Steps = follows & (np.abs(angular) > SAME)
    return turns


def _unasked(recording: Recording, now: slice) -> Steps:
    """Return a mask of the frames in which the turtle turned at a speed that no recent command had set."""
    frames = recording.frames
    times = np.array([command.t_s for command in recording.commands])
    speeds = np.array([command.angular[2] for command in recording.commands])
    found = []
    for t_s, angular in zip(frames.t_s[now], frames.angular[now], strict=True):
        recent = speeds[(times <= t_s + 2.0 * FRAME_S) & (times >= t_s - KEPT_S)] if len(times) else speeds
        found.append(abs(angular) > SAME and not (np.abs(recent - angular) <= SAME).any())
    return np.array(found, dtype=bool)
