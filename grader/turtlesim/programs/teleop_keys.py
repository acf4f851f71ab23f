"""The keys of turtle_teleop_key: pure functions that translate the characters from a terminal into commands."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Drive:
    """Drive forwards (1) or backwards (-1) for a second, or turn left (1) or right (-1). The node scales the values."""

    linear: float
    angular: float


@dataclass(frozen=True)
class Turn:
    """Turn to `theta` (rad, counter-clockwise from east)."""

    theta: float


@dataclass(frozen=True)
class Cancel:
    """Stop the current turn."""


@dataclass(frozen=True)
class Quit:
    """Quit the program."""


Key = Drive | Turn | Cancel | Quit

_ARROWS = {"A": Drive(1.0, 0.0), "B": Drive(-1.0, 0.0), "C": Drive(0.0, -1.0), "D": Drive(0.0, 1.0)}
# The keys around F on the keyboard. Each key turns the turtle to the direction from F to the key.
_LETTERS: dict[str, Key] = {
    "g": Turn(0.0),
    "t": Turn(math.pi / 4),
    "r": Turn(math.pi / 2),
    "e": Turn(3 * math.pi / 4),
    "d": Turn(math.pi),
    "c": Turn(-3 * math.pi / 4),
    "v": Turn(-math.pi / 2),
    "b": Turn(-math.pi / 4),
    "f": Cancel(),
    "q": Quit(),
    # Ctrl-D means the end of the input.
    "\x04": Quit(),
}
# An arrow key sends ESC [ A or, if a program left the keypad in application mode, ESC O A. With a modifier key such as
# Shift, the sequence also contains numbers.
_SEQUENCE = re.compile(r"\x1b(?:\[[0-9;]*([@-~])|O([@-~]))")
_UNFINISHED = re.compile(r"\x1b(?:\[[0-9;]*|O)?\Z")


def keys(text: str) -> tuple[list[Key], str]:
    """Return the commands in order, and the incomplete escape sequence at the end of the text. Ignore other keys."""
    typed: list[Key] = []
    at = 0
    while at < len(text):
        sequence = _SEQUENCE.match(text, at)
        if sequence:
            arrow = _ARROWS.get(sequence[1] or sequence[2])
            typed += [arrow] if arrow else []
            at = sequence.end()
        elif _UNFINISHED.match(text, at):
            break
        else:
            key = _LETTERS.get(text[at].lower())
            typed += [key] if key else []
            at += 1
    return typed, text[at:]
