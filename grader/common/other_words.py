"""Words that people type as a command of `grader`, and the commands that they mean."""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

_STEP = re.compile(r"\d{1,2}(-[a-z-]+)?")
_MEANT = {
    "grader start next": "next",
    "grader start": "begin new init continue resume",
    "grader start STEP --fresh": "restart reset again",
    "grader check": "test tests verify judge submit evaluate score mark points",
    "grader run": "build compile launch exec execute node drive",
    "grader open": "lesson lessons read course page gui web browser",
    "grader status": "list ls steps step progress exercises",
    "grader solution STEP": "answer answers solve solutions",
    "grader hint": "tip tips clue stuck",
    "grader sim --view": "turtlesim turtlesim_node turtle simulate simulator simulation",
    "make demo": "setup set-up install update upgrade demo",
    "grader doctor": "diagnose version info",
    "grader --help": "help man commands usage",
}


def command_for(word: str) -> str:
    """Return the command that a user who types `grader WORD` probably means, or an empty string."""
    return next((command for command, words in _MEANT.items() if word.lower() in words.split()), "")


def with_exercise(command: str, words: Sequence[str]) -> str:
    """Return the command that grades the package in `words` for the step in `words`, or an empty string.

    Example:
        >>> with_exercise("grader check", ["03", "mine"])
        'grader check mine --exercise 03'
    """
    named = [word for word in words if _STEP.fullmatch(word)]
    others = [word for word in words if word not in named and not word.startswith("-")]
    return f"{command} {shlex.quote(others[0])} --exercise {named[0]}" if len(named) == len(others) == 1 else ""
