"""The content of the terminal: the canvas, the last command and the topics next to it, and the output below."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Protocol

from rich.console import Group
from rich.table import Table
from rich.text import Text

from grader.common.words import printable
from grader.graph.graph import Show
from grader.turtlesim.turtle import TIME_OUT_S
from grader.view.blocks import Blocks, Picture
from grader.view.topics import rows

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rich.console import Console, ConsoleOptions, RenderResult

    from grader.view.state import State
    from grader.view.system import System

BESIDE = 38
"""The minimum number of columns next to the canvas. With less than twice this width, the terminal
shows nothing there."""
_BELOW = 6
"""The number of rows for the title, the simulator's output and the keys, including one empty row."""
_LEAST = 8
_KEYS = "↑ ↓ ← → drive · E R T D G C V B turn, F stops · Space pause · X clear · Z reset · Tab turtle · Q quit"


class Shown(Protocol):
    """The data that the screen shows."""

    @property
    def state(self) -> State:
        """The state of the simulator."""

    @property
    def system(self) -> System | None:
        """The ROS graph and the rates of topics, or None if they are not known yet."""

    @property
    def lines(self) -> Iterable[str]:
        """The last lines of the simulator's output."""

    @property
    def chosen(self) -> str:
        """The name of the turtle that the keys drive."""

    @property
    def picture(self) -> Picture:
        """The canvas."""


def side_for(console: Console) -> int:
    """Return the width of the canvas in columns: the largest even number that fits, but at least 8."""
    width, height = console.size
    beside = BESIDE if width >= 2 * BESIDE else 0
    return max(min(width - beside, 2 * (height - _BELOW)), _LEAST) // 2 * 2


class Screen:
    """The whole screen, as an object that the library rich can print."""

    def __init__(self, shown: Shown) -> None:
        self._shown = shown

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the parts of the screen from top to bottom."""
        shown = self._shown
        canvas = Blocks(shown.picture.of(shown.state))
        yield self._title()
        if console.width >= 2 * BESIDE:
            grid = Table.grid(padding=(0, 2))
            grid.add_column(width=shown.picture.side)
            grid.add_column(width=min(console.width - shown.picture.side - 3, 60))
            grid.add_row(canvas, self._beside(shown.picture.side // 2))
            yield grid
        else:
            yield canvas
        for line in [*shown.lines, "", "", ""][:3]:
            yield Text(printable(line), style="dim", no_wrap=True, overflow="ellipsis")
        yield Text(_KEYS, style="bold", no_wrap=True, overflow="ellipsis")

    def _title(self) -> Text:
        state = self._shown.state
        status = ("● paused ", "bold yellow") if state.paused else ("● live ", "bold green")
        return Text.assemble(("turtlesim ", "bold"), status, no_wrap=True)

    def _beside(self, height: int) -> Group:
        shown = self._shown
        parts = [*self._turtle(), Text(), *_topics(shown.system, shown.state)]
        return Group(*parts[:height])

    def _turtle(self) -> list[Text]:
        state, name = self._shown.state, self._shown.chosen
        turtle = state.turtles.get(name)
        if turtle is None:
            return [Text(f"{name} does not exist. Press Tab to choose another turtle.")]
        others = f"  ({list(state.turtles).index(name) + 1} of {len(state.turtles)})" if len(state.turtles) > 1 else ""
        lines = [
            Text.assemble((printable(name), "bold"), others),
            Text(f"x {turtle.x:6.2f} m   y {turtle.y:6.2f} m"),
            Text(f"heading {turtle.theta:6.2f} rad"),
            Text(),
        ]
        topic = next((topic for topic in state.commands if topic.endswith(f"/{name}/cmd_vel")), None)
        if topic is None:
            return [*lines, Text("No command has arrived yet.", style="dim")]
        command = state.commands[topic]
        old = "dim" if time.monotonic() - command.when_s > TIME_OUT_S else ""
        linear, angular = command.twist[0], command.twist[5]
        return [
            *lines,
            Text("Last command", style="bold"),
            Text.assemble((f"{_straight(linear)} linear.x  {linear:6.2f} m/s", old or "orange3")),
            Text.assemble((f"{_bent(angular)} angular.z {angular:6.2f} rad/s", old or "medium_purple1")),
        ]


def _straight(value: float) -> str:
    return "·" if value == 0 or math.isnan(value) else "↑" if value > 0 else "↓"


def _bent(value: float) -> str:
    return "·" if value == 0 or math.isnan(value) else "↺" if value > 0 else "↻"


def _topics(system: System | None, state: State) -> list[Text]:
    if system is None:
        return []
    lines = [Text("Topics", style="bold")]
    for row in rows(system, state, Show()):
        hertz = row["hertz"]
        rate = f"{hertz:g} Hz" if isinstance(hertz, float) else "-"
        busy = "green" if isinstance(hertz, float) else "dim"
        lines.append(Text.assemble((printable(str(row["name"])), "bold"), "  ", (rate, busy), no_wrap=True))
        ends = f"  {_names(row['publishers'])} → {_names(row['subscribers'])}"
        lines.append(Text(ends, style="dim", no_wrap=True, overflow="ellipsis"))
    return lines


def _names(names: object) -> str:
    assert isinstance(names, list)
    return ", ".join(map(printable, names)) or "nobody"
