"""The state of a simulator in its view, built from the messages of feed.py. Pages and terminals show this state."""

from __future__ import annotations

import base64
import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from grader.view.rates import Arrivals
from grader.view.trail import Stroke, Trail, as_lists

Rgb = tuple[int, int, int]
MOST_RATES = 1000
"""If `State.rates` has more entries, those of silent topics are removed. A node can spawn and kill turtles without end,
and each turtle has topics of its own."""


class TurtleState(NamedTuple):
    """The state of a turtle and its pen. The units of the first five values are m, m, rad, m/s and rad/s."""

    x: float
    y: float
    theta: float
    linear: float
    angular: float
    red: int
    green: int
    blue: int
    width: int
    down: bool


class Command(NamedTuple):
    """The last command on a topic: its time on CLOCK_MONOTONIC (s), linear x, y, z (m/s), angular x, y, z (rad/s)."""

    when_s: float
    twist: tuple[float, ...]


@dataclass
class State:
    """The whole state of a simulator. `now_s` is the time of its last message."""

    now_s: float = 0.0
    paused: bool = False
    namespace: str = "/"
    background: Rgb = (69, 86, 255)
    turtles: dict[str, TurtleState] = field(default_factory=dict)
    trail: Trail = field(default_factory=Trail)
    pieces: list[Stroke] = field(default_factory=list)
    """The strokes that the last message added to the trail."""
    commands: dict[str, Command] = field(default_factory=dict)
    rates: dict[str, Arrivals] = field(default_factory=dict)
    """The arrivals on the simulator's topics. No subscription is needed to measure these rates."""

    def take(self, message: dict[str, Any]) -> dict[str, object]:
        """Apply a message from the simulator. Return the update for pages that have the previous state."""
        self.now_s = float(message["t"])
        self.paused = bool(message["paused"])
        self.namespace = str(message["namespace"])
        red, green, blue = message["background"]
        self.background = (red, green, blue)
        self.turtles = {name: TurtleState(*values) for name, values in message["turtles"].items()}
        if message["cleared"]:
            self.trail.clear()
        if message["picture"] is not None:
            self.trail.take_picture(base64.b64decode(message["picture"]))
        self.pieces = self.trail.draw(message["lines"])
        for topic, (count, last_s, twist) in message["received"].items():
            self.commands[topic] = Command(last_s, tuple(twist))
            self.rates.setdefault(topic, Arrivals()).add(last_s, count)
        for topic, count in message["sent"].items():
            self.rates.setdefault(topic, Arrivals()).add(self.now_s, count)
        if len(self.rates) > MOST_RATES:
            self.rates = {topic: each for topic, each in self.rates.items() if each.hertz(self.now_s) is not None}
        for topic in [topic for topic in self.commands if topic.split("/")[-2] not in self.turtles]:
            del self.commands[topic]
        news: dict[str, object] = {**self._now(), "lines": as_lists(self.pieces)}
        if message["cleared"] or message["picture"] is not None:
            news["trail"] = self.trail.as_message()
            del news["lines"]
        return news

    def whole(self) -> dict[str, object]:
        """Return the whole state for a new page."""
        return {**self._now(), "trail": self.trail.as_message()}

    def _now(self) -> dict[str, object]:
        return {
            "paused": self.paused,
            "background": self.background,
            "turtles": {name: _numbers(turtle) for name, turtle in self.turtles.items()},
            "commands": {
                topic: [round(self.now_s - command.when_s, 3), *_numbers(command.twist)]
                for topic, command in self.commands.items()
            },
        }


def _numbers(values: tuple[Any, ...]) -> list[object]:
    """Round to four decimal places, which are sufficient for a view.

    Infinity and NaN become None, because JSON does not support them.
    """
    return [_number(value) if isinstance(value, float) else value for value in values]


def _number(value: float) -> float | None:
    return round(value, 4) if math.isfinite(value) else None
