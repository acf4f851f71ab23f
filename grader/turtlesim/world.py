"""All turtles on one canvas, moved frame by frame. This module has no clock: the caller passes the time."""

from __future__ import annotations

import itertools

from grader.turtlesim.canvas import Canvas
from grader.turtlesim.turtle import FRAME_S, Start, Turtle


class World:
    """The turtles by name, the canvas, and the parameter `holonomic`."""

    def __init__(self, start: Start = Start(), canvas: Canvas | None = None) -> None:  # noqa: B008
        self.canvas = canvas or Canvas()
        self.holonomic = False
        self.turtles: dict[str, Turtle] = {}
        self._start = start
        self.reset()

    def reset(self) -> None:
        """Remove all turtles and the trail, and put turtle1 at its start. Parameters do not change."""
        for turtle in self.turtles.values():
            turtle.abort_rotation()
        self.turtles.clear()
        self._numbers = itertools.count(1)
        self.spawn("", self._start)
        self.canvas.clear()

    def new_name(self) -> str:
        """Return the next free name of the form turtleN.

        Between two resets, this method never returns the same name twice.
        """
        return next(name for number in self._numbers if (name := f"turtle{number}") not in self.turtles)

    def spawn(self, name: str, start: Start) -> str:
        """Add a turtle and return its name, or "" if `name` is taken. An empty `name` means the next free name."""
        if name in self.turtles:
            return ""
        name = name or self.new_name()
        self.turtles[name] = Turtle(start)
        # turtlesim moves its turtles in the order of their names, which determines whose line is on top.
        self.turtles = dict(sorted(self.turtles.items()))
        return name

    def kill(self, name: str) -> bool:
        """Remove a turtle but keep its trail. Return False if no turtle has that name."""
        turtle = self.turtles.pop(name, None)
        if turtle is None:
            return False
        turtle.abort_rotation()
        return True

    def command(self, name: str, linear_x: float, linear_y: float, angular_z: float) -> None:
        """Send a velocity command (m/s, m/s, rad/s) to a turtle. `linear_y` affects only holonomic turtles."""
        self.turtles[name].command(linear_x, linear_y if self.holonomic else None, angular_z)

    def step(self, now_s: float) -> None:
        """Advance every turtle by one frame (16 ms) at the time `now_s` (s on the caller's clock)."""
        for turtle in self.turtles.values():
            turtle.update(FRAME_S, now_s, self.canvas)
