"""Made-up crashes: a node's source, the line where it crashed, and Python's message."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.causes.crash import START, crash_of
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.edit import applied
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission
from grader.tests.checks.shapes import crashed
from grader.trial.recording import Output

if TYPE_CHECKING:
    from grader.checks.outcome import Finding

CRASHED, LOOK = "# crashed", "# look"
"""Comments in a source that mark the line of the exception, and the line that the report must name if it differs."""

DRIVER = """\
from rclpy.node import Node

class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.count = 0

    def send(self, step=1):
        {line}  # crashed

def outside():
    pass
"""
"""A node that crashes, with one line to fill in."""


@dataclass(frozen=True)
class Reported:
    """The report of a crash: the diagnosis, the line to look at, and the cause in words."""

    diagnosis: str | None
    line: int | None
    cause: str


def line_with(comment: str, source: str) -> int | None:
    """Return the number of the line that ends with this comment, counted from 1."""
    lines = [number for number, line in enumerate(source.splitlines(), 1) if line.endswith(comment)]
    return lines[0] if lines else None


def to_look_at(source: str) -> int | None:
    """Return the line that is marked as expected in the report, or else the line that crashed."""
    return line_with(LOOK, source) or line_with(CRASHED, source)


def reported(source: str, error: str, files: dict[str, str] | None = None, caller: int | None = None) -> Reported:
    """Return the report of a node with this source that ended with this error.

    `files` are the other files of the package. `caller` is the line of the call in which the exception was raised.
    """
    finding = _finding(source, error, files, caller)
    return Reported(finding.diagnosis, None if finding.where is None else finding.where.line, finding.cause)


def fixed(source: str, error: str) -> str | None:
    """Return the source code with the reported cause fixed, or None if there is no fix for it."""
    changed = applied({NODE_FILE: source.encode()}, _finding(source, error, None).fix)
    return None if changed is None or changed[NODE_FILE] == source.encode() else changed[NODE_FILE].decode()


def _finding(source: str, error: str, files: dict[str, str] | None, caller: int | None = None) -> Finding:
    frame = f'  File "/ws/lib/python3.11/site-packages/{NODE_FILE}", line {line_with(CRASHED, source)}, in send\n'
    outer = frame.replace(f"line {line_with(CRASHED, source)},", f"line {caller},") if caller is not None else ""
    text = f"{START}\n{outer}{frame if CRASHED in source else ''}    the line itself\n{error}\n"
    trial = recording([], end=crashed(0.5), stderr=Output(text))
    given = evidence(trial, submission({NODE_FILE: source, **(files or {})}))
    crash = crash_of(given)
    assert crash is not None
    return crash_finding(given, crash, "It crashed.", "It runs.")
