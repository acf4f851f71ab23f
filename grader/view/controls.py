"""The input from a view: keys that drive the turtle while they are held, keys that turn it, and buttons."""

from __future__ import annotations

import json
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from grader.turtlesim.programs.teleop_keys import Cancel, Drive, Key, Turn, keys

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable

    from grader.view.state import State
    from grader.view.system import Ears

BUTTONS = ("pause", "resume", "clear", "reset")
ARROWS = {
    "up": Drive(1.0, 0.0),
    "down": Drive(-1.0, 0.0),
    "left": Drive(0.0, 1.0),
    "right": Drive(0.0, -1.0),
}


def together(held: list[str]) -> Drive:
    """Return the drive command for the combination of all held arrow keys."""
    drives = [ARROWS[key] for key in dict.fromkeys(held) if key in ARROWS]
    return Drive(sum(drive.linear for drive in drives), sum(drive.angular for drive in drives))


class Hands:
    """Passes key presses to ROS, and button presses to the simulator. `state` contains the turtles.

    `listen` is called when a page requests the log messages of all nodes.
    """

    def __init__(
        self, ears: Ears, state: State, simulator: socket.socket | None, listen: Callable[[], object] = lambda: None
    ) -> None:
        self._ears = ears
        self._state = state
        self._simulator = simulator
        self._listen = listen
        self._driving: dict[object, str] = {}
        """Maps each page to the turtle that the page drives."""
        self._drivers: set[object] = set()

    def receive(self, page: object, said: dict[str, Any]) -> bool:
        """Handle a message from a page: held keys, a pressed key, a button, or a request for log messages.

        Return whether any keys are held down.
        """
        if "held" in said:
            keys = [str(key) for key in said["held"]]
            self.held(page, str(said["turtle"]), keys)
            return bool(keys)
        if "press" in said:
            self.pressed(str(said["turtle"]), str(said["press"]))
        elif "do" in said:
            self.request(str(said["do"]))
        elif "log" in said:
            self._listen()
        return page in self._driving

    def held(self, page: object, turtle: str, keys: list[str]) -> None:
        """Drive while keys are held. Stop when the keys are released."""
        topic = self._full(turtle)
        if topic is None:
            return
        arrows = [key for key in keys if key in ARROWS]
        if arrows:
            self._driving[page] = topic
            self._drivers.add(page)
            self._ears.drive(topic, together(arrows))
        elif self._driving.pop(page, None) is not None:
            self._ears.drive(topic, Drive(0.0, 0.0))

    def let_go(self, page: object) -> None:
        """Stop the turtle that this page drives."""
        topic = self._driving.pop(page, None)
        if topic is not None:
            self._ears.drive(topic, Drive(0.0, 0.0))

    def gone(self, page: object) -> None:
        """Remove a closed page. When all pages that drove a turtle are closed, the driving node leaves the graph."""
        self.let_go(page)
        if page in self._drivers:
            self._drivers.discard(page)
            if not self._drivers:
                self._ears.leave()

    def pressed(self, turtle: str, key: str) -> None:
        """Turn to the heading of the key (the direction from F to the key on the keyboard), or stop turning."""
        typed, _ = keys(key[:1])
        if typed:
            self.turn(turtle, typed[0])

    def turn(self, turtle: str, key: Key) -> None:
        """Turn to the heading of the key, or cancel the turn. Ignore every other key."""
        topic = self._full(turtle)
        if topic is not None and isinstance(key, Turn | Cancel):
            self._ears.drive(topic, key)

    def request(self, what: str) -> None:
        """Send the simulator a request to pause, resume, clear or reset."""
        if what in BUTTONS and self._simulator is not None:
            # A simulator that is exiting no longer reads requests.
            with suppress(OSError):
                self._simulator.send(json.dumps(what).encode())

    def _full(self, turtle: str) -> str | None:
        """Return the full name of a turtle, or None if there is no such turtle: pages must not create topics."""
        if turtle not in self._state.turtles:
            return None
        return f"{self._state.namespace.rstrip('/')}/{turtle}"
