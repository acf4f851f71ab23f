"""The motion of one turtle, frame by frame, as in turtlesim 1.8. This module needs neither ROS nor a clock.

Positions are in m from the lower left corner, angles are in rad counter-clockwise from east, and times are in s on the
caller's clock. The state is stored in doubles, which become float32 in messages.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple, Protocol

FRAME_S = 0.016
"""The duration of one frame (s). turtlesim advances by this time, even if a frame is late."""

PIXELS_PER_M = 45
SIDE_PX = 500
# turtlesim stores the size of the canvas in 32-bit floats, which determines the position of the walls and the start.
SIDE_M = 11.088889122009277
"""The length of a side of the canvas (m), which is (SIDE_PX - 1) / PIXELS_PER_M as a float32."""

TIME_OUT_S = 1.0
"""A turtle stops when its last command is older than this (s)."""

ROTATE_SPEED = 1.0
"""The angular speed of rotate_absolute (rad/s)."""
ROTATE_TOLERANCE = 0.02
"""rotate_absolute succeeds when the remaining angle (rad) is smaller than this value."""

Rgb = tuple[int, int, int]


def normalize(angle: float) -> float:
    """Return the same direction as an angle in [-pi, pi), or nan for nan and infinity."""
    if -math.pi <= angle < math.pi:
        return angle
    if not math.isfinite(angle):
        return math.nan
    # fmod is exact, so the result is in the interval even for a huge angle. This is not true for turtlesim's formula.
    turned = math.fmod(angle + math.pi, math.tau)
    turned += math.pi if turned < 0.0 else -math.pi
    return turned if turned < math.pi else -math.pi


class Start(NamedTuple):
    """The start pose of a turtle: x, y in m, theta in rad."""

    x: float = SIDE_M / 2
    y: float = SIDE_M / 2
    theta: float = 0.0


@dataclass(frozen=True)
class Pen:
    """The pen of a turtle. `width` is in pixels."""

    color: Rgb = (179, 184, 255)
    width: int = 3
    down: bool = True


class State(NamedTuple):
    """The state of a turtle after a frame, in m, rad, m/s (never negative) and rad/s.

    `wall` is true if the turtle hit a wall.
    """

    x: float
    y: float
    theta: float
    linear: float
    angular: float
    wall: bool


class Paper(Protocol):
    """The surface on which a turtle draws, and from which the turtle's sensor reads colours. Coordinates are in m."""

    def line(self, x0: float, y0: float, x1: float, y1: float, pen: Pen) -> None:
        """Draw a line from (x0, y0) to (x1, y1)."""

    def color_at(self, x: float, y: float) -> Rgb:
        """Return the colour at (x, y)."""


@dataclass
class Rotation:
    """A goal of rotate_absolute. `theta`, `start`, `remaining` and `delta` are in rad."""

    theta: float
    start: float
    remaining: float = 0.0
    delta: float = 0.0
    """The turn (rad) from the current direction back to the start. The `delta` in turtlesim's result has the same
    sign."""
    cancel: bool = False
    """Whether a client has requested the cancellation of the goal. The next frame handles the request."""
    end: Literal["succeeded", "canceled", "aborted"] | None = None


class _Absolute(NamedTuple):
    x: float
    y: float
    theta: float


class _Relative(NamedTuple):
    linear: float
    angular: float


class Turtle:
    """One turtle. A command sets the velocities immediately. All movements, also teleports, take place in `update`."""

    def __init__(self, start: Start = Start()) -> None:  # noqa: B008 (a tuple cannot be changed)
        self.x, self.y, self.theta = start
        self.pen = Pen()
        self.color: Rgb = (0, 0, 0)
        """The colour that the sensor read in the last frame."""
        self.rotation: Rotation | None = None
        self.clamped_from: tuple[float, float] | None = None
        """The position that the turtle would have had in the last frame without walls, or None if it hit no wall."""
        self.last_command_s: float | None = None
        self._command_is_new = False
        self._vx = self._vy = self._spin = 0.0
        self._teleports: list[_Absolute | _Relative] = []

    def state(self) -> State:
        """Return the state of the turtle after the last frame."""
        speed = math.sqrt(self._vx * self._vx + self._vy * self._vy)
        return State(self.x, self.y, self.theta, speed, self._spin, self.clamped_from is not None)

    def command(self, linear_x: float, linear_y: float | None, angular_z: float) -> None:
        """Set the velocities (m/s, m/s, rad/s), and abort the current rotation.

        If `linear_y` is None, the sideways velocity does not change, as in a turtlesim that is not holonomic. A turtle
        that has just stopped being holonomic therefore drifts sideways until its last command times out.
        """
        self.abort_rotation()
        self._vx, self._spin = linear_x, angular_z
        if linear_y is not None:
            self._vy = linear_y
        self._command_is_new = True

    def teleport_absolute(self, x: float, y: float, theta: float) -> None:
        """Request a teleport to (x, y) with the direction theta."""
        self._teleports.append(_Absolute(x, y, theta))

    def teleport_relative(self, linear: float, angular: float) -> None:
        """Request a teleport: turn by `angular`, and then move forwards by `linear`."""
        self._teleports.append(_Relative(linear, angular))

    def rotate_to(self, theta: float) -> Rotation:
        """Accept a goal of rotate_absolute, and abort the current goal, if any."""
        self.abort_rotation()
        self.rotation = Rotation(theta=theta, start=self.theta)
        return self.rotation

    def abort_rotation(self) -> None:
        """Abort the current rotation, if any."""
        if self.rotation is not None:
            self.rotation.end = "aborted"
            self.rotation = None

    def update(self, dt: float, now_s: float, paper: Paper) -> None:
        """Advance the turtle by one frame of `dt` (s) at the time `now_s` (s)."""
        self._take_new_command(now_s)
        if self._teleports:
            self._teleport(paper)
        if self.rotation is not None:
            self._rotate(self.rotation, now_s)
        self._time_out(now_s)
        x, y = self.x, self.y
        self._move(dt)
        self._clamp()
        # The sensor reads the canvas before the pen draws, so its colour does not include this frame's line.
        self.color = paper.color_at(self.x, self.y)
        if (self.x != x or self.y != y) and self.pen.down:
            paper.line(x, y, self.x, self.y, self.pen)

    def _take_new_command(self, now_s: float) -> None:
        # turtlesim runs its callbacks at the start of a frame, so the age of a command is measured from there.
        if self._command_is_new:
            self.last_command_s = now_s
            self._command_is_new = False

    def _teleport(self, paper: Paper) -> None:
        for request in self._teleports:
            x, y = self.x, self.y
            if isinstance(request, _Absolute):
                # turtlesim clamps the position at the upper edge here, but at the other edges only later.
                self.x, self.y = request.x, min(request.y, SIDE_M)
                self.theta = normalize(request.theta)
            else:
                self.theta = normalize(self.theta + request.angular)
                self.x += math.cos(self.theta) * request.linear
                self.y += math.sin(self.theta) * request.linear
            if self.pen.down:
                paper.line(x, y, self.x, self.y, self.pen)
        self._teleports.clear()

    def _rotate(self, rotation: Rotation, now_s: float) -> None:
        if rotation.cancel:
            self._end_rotation(rotation, "canceled")
            return
        rotation.remaining = normalize(normalize(rotation.theta) - self.theta)
        rotation.delta = normalize(rotation.start - self.theta)
        if abs(rotation.remaining) < ROTATE_TOLERANCE:
            self._end_rotation(rotation, "succeeded")
            return
        self._vx = self._vy = 0.0
        self._spin = -ROTATE_SPEED if rotation.remaining < 0.0 else ROTATE_SPEED
        # A rotation may last longer than the command time-out.
        self.last_command_s = now_s

    def _end_rotation(self, rotation: Rotation, end: Literal["succeeded", "canceled"]) -> None:
        rotation.end = end
        self.rotation = None
        self._vx = self._vy = self._spin = 0.0

    def _time_out(self, now_s: float) -> None:
        if self.last_command_s is not None and now_s - self.last_command_s > TIME_OUT_S:
            self._vx = self._vy = self._spin = 0.0

    def _move(self, dt: float) -> None:
        self.theta = normalize(self.theta + self._spin * dt)
        cos, sin = math.cos(self.theta), math.sin(self.theta)
        self.x += (cos * self._vx - sin * self._vy) * dt
        self.y += (sin * self._vx + cos * self._vy) * dt

    def _clamp(self) -> None:
        # These comparisons let nan pass through to the pose, as in turtlesim.
        if self.x < 0.0 or self.x > SIDE_M or self.y < 0.0 or self.y > SIDE_M:
            self.clamped_from = (self.x, self.y)
            self.x = min(max(self.x, 0.0), SIDE_M)
            self.y = min(max(self.y, 0.0), SIDE_M)
        else:
            self.clamped_from = None
