"""The view in a terminal: the turtle as half blocks, the topics next to it, and keys that drive the turtle.

A terminal does not report when a key is released. A held key repeats, so a key counts as released when it stops
repeating.
"""

from __future__ import annotations

import json
import os
import signal
import time
from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rich.console import Console
from rich.live import Live

from grader.graph.discovery import cli_node
from grader.turtlesim.programs.raw_terminal import keyboard
from grader.turtlesim.programs.teleop_keys import Drive, Quit, keys
from grader.view.blocks import Picture
from grader.view.controls import ARROWS, Hands
from grader.view.feed import LARGEST
from grader.view.state import State
from grader.view.system import Ears, System
from grader.view.terminal_screen import Screen, side_for
from grader.view.topics import VIEWS

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable

FRAME_S = 0.066
FIRST_HOLD_S = 0.6
"""After its first press, a key counts as held for this time (s). On most machines, a held key repeats after 0.5 s."""
HOLD_S = 0.25
"""After each repeat, a key counts as held for this time (s): the interval between repeats with the slowest settings."""
_LINES = 3


@dataclass
class Held:
    """The held arrow key, and the time until which it counts as held (s)."""

    key: str = ""
    until_s: float = 0.0

    def press(self, key: str, now: float) -> None:
        """Handle an arrow key that is pressed for the first time or repeated."""
        again = key == self.key and now < self.until_s
        self.key, self.until_s = key, now + (HOLD_S if again else FIRST_HOLD_S)

    def over(self, now: float) -> bool:
        """Return whether the key no longer counts as held."""
        return bool(self.key) and now >= self.until_s


@dataclass(eq=False)
class Terminal:
    """The state of the drawing loop."""

    feed: socket.socket
    said: int
    state: State = field(default_factory=State)
    system: System | None = None
    lines: deque[str] = field(default_factory=lambda: deque(maxlen=_LINES))
    chosen: str = "turtle1"
    changed: bool = True
    picture: Picture = field(default_factory=lambda: Picture(2))
    held: Held = field(default_factory=Held)
    typed: str = ""
    _rest: str = ""

    def hear(self) -> bool:
        """Read the messages from the simulator. Return False if the simulator has exited."""
        while True:
            try:
                data = self.feed.recv(LARGEST)
            except BlockingIOError:
                return True
            except OSError:
                return False
            if not data:
                return False
            news = self.state.take(json.loads(data))
            if "trail" in news:
                self.picture.begin(self.state)
            else:
                self.picture.add(self.state.pieces)
            self.changed = True

    def read_lines(self) -> None:
        """Read the output of the simulator."""
        try:
            data = os.read(self.said, 65536)
        except BlockingIOError:
            return
        *lines, self._rest = (self._rest + data.decode("utf-8", "replace")).split("\n")
        self.lines.extend(lines)
        self.changed |= bool(lines)

    def next_turtle(self) -> None:
        """Select the next turtle for the keys."""
        names = list(self.state.turtles)
        if names:
            at = names.index(self.chosen) + 1 if self.chosen in names else 0
            self.chosen = names[at % len(names)]


def watch(feed: socket.socket, said: int) -> int:
    """Draw until the simulator exits, or until Q or Ctrl-C is pressed. Return the exit code."""
    console = Console(highlight=False, no_color=False)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    feed.settimeout(0.0)
    os.set_blocking(said, False)
    shown = Terminal(feed, said)

    def look(system: System) -> None:
        shown.system = system

    try:
        with (
            cli_node(f"{VIEWS[1:]}{os.getpid()}") as node,
            Ears(node, look, looking=lambda: True, known=lambda: list(shown.state.rates)) as ears,
            keyboard() as read,
            Live(
                console=console, screen=True, auto_refresh=False, redirect_stderr=False, redirect_stdout=False
            ) as live,
        ):
            _loop(shown, read, live, Hands(ears, shown.state, feed))
    except KeyboardInterrupt:
        pass
    return 0


def _loop(shown: Terminal, read: Callable[..., bytes | None], live: Live, hands: Hands) -> None:
    drawn_s = 0.0
    while shown.hear():
        shown.read_lines()
        now = time.monotonic()
        if shown.held.over(now):
            shown.held.key = ""
            hands.let_go(shown)
        side = side_for(live.console)
        if side != shown.picture.side:
            shown.picture = Picture(side)
            shown.picture.begin(shown.state)
            shown.changed = True
        if shown.changed or now - drawn_s >= 0.5:
            drawn_s, shown.changed = now, False
            live.update(Screen(shown), refresh=True)
        data = read(max(drawn_s + FRAME_S - time.monotonic(), 0.005))
        if data == b"" or (data and not _do(shown, data, hands)):
            return


def _do(shown: Terminal, data: bytes, hands: Hands) -> bool:
    """Handle the keys. Return False if a key quits the program."""
    text = data.decode("latin-1")
    for char, what in ((" ", "resume" if shown.state.paused else "pause"), ("x", "clear"), ("z", "reset")):
        if char in text.lower():
            hands.request(what)
    if "\t" in text:
        shown.next_turtle()
    typed, shown.typed = keys(shown.typed + text)
    for key in typed:
        if isinstance(key, Quit):
            return False
        if isinstance(key, Drive):
            name = next(name for name, drive in ARROWS.items() if drive == key)
            shown.held.press(name, time.monotonic())
            hands.held(shown, shown.chosen, [name])
        else:
            hands.turn(shown.chosen, key)
    return True
