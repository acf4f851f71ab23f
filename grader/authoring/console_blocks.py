"""The fenced blocks of a Markdown page, and the commands in its console blocks.

A console block begins with ```console. The block contains lines of the form `$ command`, each followed by the command's
output.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

FENCE = re.compile(r"^```(\w*) ?([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Step:
    """A command, and the lines that the page shows as its output."""

    command: str
    printed: tuple[str, ...]


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, the rest of its first line, and its text."""

    language: str
    about: str
    text: str

    def steps(self) -> tuple[Step, ...]:
        """Return the commands of a console block. Raises ValueError for output before the first command."""
        steps: list[Step] = []
        for line in self.text.splitlines():
            if line.startswith("$ "):
                steps.append(Step(line.removeprefix("$ "), ()))
            elif steps:
                steps[-1] = Step(steps[-1].command, (*steps[-1].printed, line))
            else:
                message = f"output without a command: {line!r}"
                raise ValueError(message)
        return tuple(steps)


def blocks(markdown: str) -> tuple[Block, ...]:
    """Return the fenced blocks of a text, in order."""
    return tuple(Block(*match.groups()) for match in FENCE.finditer(markdown))
