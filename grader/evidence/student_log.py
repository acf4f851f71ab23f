"""Log lines that the student's node wrote, and the format that the lesson requires."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.evidence import activity

if TYPE_CHECKING:
    from grader.trial.recording import LogLine, Recording

FIELD = re.compile(r"\{(?P<name>[a-z_]+)(?::\.(?P<digits>\d)f)?\}")


@dataclass(frozen=True)
class Format:
    """The format of a line that contains numbers, such as "Hello {counter}" or "x={x:.2f}" with two decimal places."""

    text: str

    def pattern(self) -> re.Pattern[str]:
        """Return the pattern that a whole line must match. The groups of the pattern capture the numbers."""
        parts, at = [], 0
        for match in FIELD.finditer(self.text):
            digits = match["digits"]
            number = r"-?\d{1,15}" + (rf"\.\d{{{digits}}}" if digits else "")
            parts += [re.escape(self.text[at : match.start()]), f"(?P<{match['name']}>{number})"]
            at = match.end()
        return re.compile("".join([*parts, re.escape(self.text[at:])]), re.ASCII)

    def example(self, number: float = 0.0) -> str:
        """Return an example line in this format, with the same number in every field."""
        return FIELD.sub(lambda match: f"{number:.{match['digits'] or 0}f}", self.text)


@dataclass(frozen=True)
class Line:
    """A log line in the required format, with its arrival time (s) and its numbers."""

    t_s: float
    numbers: dict[str, float]


def students(recording: Recording) -> tuple[LogLine, ...]:
    """Return the lines that the submission logged before the end of the scenario, in the order of arrival.

    The logger of a node has the name of the node, with dots instead of slashes.
    """
    until = activity.end_s(recording)
    ours = {node.strip("/").replace("/", ".") for node in recording.own_nodes}
    return tuple(line for line in recording.log if line.logger not in ours and line.t_s < until)


def in_format(recording: Recording, text: str) -> tuple[Line, ...]:
    """Return the lines that match the format."""
    pattern = Format(text).pattern()
    found = ((line.t_s, pattern.fullmatch(line.text)) for line in students(recording))
    return tuple(
        Line(t_s, {name: float(number) for name, number in match.groupdict().items()})
        for t_s, match in found
        if match is not None
    )
