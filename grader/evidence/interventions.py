"""Find out from the movement itself whether something other than velocity commands moved the turtle.

turtlesim moves a turtle in each frame by its velocities alone. A frame in which the turtle moved differently, or with a
turning speed that no command set, shows a teleport, a reset or a rotate_absolute goal.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.common.lazy import np
from grader.evidence import activity

if TYPE_CHECKING:
    from grader.trial.recording import Floats, Recording

MOVING = frozenset({"reset", "teleport_absolute", "teleport_relative", "rotate_absolute"})
"""Calls that may move a turtle. Such a call has no effect if the turtle is already at the destination."""
ALWAYS = frozenset({"kill", "set_parameters"})
"""Calls that remove a turtle or change its response to commands."""
FRAME_S = 0.016
SAME = 1e-5
"""The largest difference (m, rad, rad/s) that counts as zero."""
KEPT_S = 1.1
"""turtlesim stops a turtle when no command arrives for 1 s."""


def moved_by(recording: Recording, *, from_start: bool) -> str | None:
    """Return the call that moved the turtle, or None.

    With `from_start`, all calls since the start of the trial count. Without `from_start`, only events after the first
    command count.
    """
    always = next((name for name in recording.interventions if name in ALWAYS), None)
    names = [name for name in recording.interventions if name in MOVING]
    if always is not None or not names:
        return always
    first = 0 if from_start else first_driven(recording)
    return names[0] if _moved(recording, first) else None


def first_driven(recording: Recording) -> int:
    """Return the index of the first frame in which a command can have moved the turtle."""
    begin_s = min((command.t_s for command in recording.commands), default=0.0)
    return int(np.searchsorted(recording.frames.t_s, begin_s))


def _moved(recording: Recording, first: int) -> bool:
    """Return whether this frame or a later frame shows a movement that the velocities or commands do not explain."""
    frames = recording.frames
    stop = int(np.searchsorted(frames.t_s, activity.end_s(recording), side="right"))
    begin = recording.start if first == 0 else None
    x, y, theta = (
        values[first - 1 : stop] if begin is None else np.append(start, values[:stop])
        for values, start in (
            (frames.x, recording.start.x),
            (frames.y, recording.start.y),
            (frames.theta, recording.start.theta),
        )
    )
    now = slice(first, stop)
    dx, dy = np.diff(x), np.diff(y)
    turned = np.mod(np.diff(theta) - frames.angular[now] * FRAME_S + np.pi, 2.0 * np.pi) - np.pi
    far = np.abs(np.hypot(dx, dy) - np.abs(frames.linear[now]) * FRAME_S)
    aside = np.abs(dx * np.sin(theta[1:]) - dy * np.cos(theta[1:]))
    by_position = ~((far <= SAME) & (aside <= SAME) | frames.wall[now])
    return bool((by_position | ~(np.abs(turned) <= SAME) | _unasked(recording, now)).any())


def _unasked(recording: Recording, now: slice) -> Floats:
    """Return an array that says which of these frames have a turning speed that no recent command set."""
    frames = recording.frames
    times = np.array([command.t_s for command in recording.commands])
    speeds = np.array([command.angular[2] for command in recording.commands])
    found = []
    for t_s, angular in zip(frames.t_s[now], frames.angular[now], strict=True):
        recent = speeds[(times <= t_s + 2.0 * FRAME_S) & (times >= t_s - KEPT_S)] if len(times) else speeds
        found.append(abs(angular) > SAME and not (np.abs(recent - angular) <= SAME).any())
    return np.array(found, dtype=bool)
