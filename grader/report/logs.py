"""The logs of the build and the node, with the lines that look like errors first."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.words import count
from grader.report.plain import Cut, cut, plain_line, size

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.evidence.evidence import Evidence
    from grader.trial.recording import Output

HEAD_BYTES, TAIL_BYTES, ERROR_BYTES = 20_000, 14_000, 6_000
LOOKED_AT = 400_000
"""The number of characters at the end of a log that are searched for errors."""
MOST_ERRORS = 40
ERROR = re.compile(r"\b(?:Traceback \(most|\w*Error\b|\w*Exception\b|error:|ERROR|FATAL|Failed\b)|\[ERROR\]")
BEGINS = "Traceback (most recent call last):"


@dataclass(frozen=True)
class Size:
    """The maximum number of bytes that a page shows of the beginning, the end and the errors of a log."""

    head: int
    tail: int
    errors: int


@dataclass(frozen=True)
class Log:
    """One log. `errors` contains the lines that look like errors, with their line numbers."""

    key: str
    title: str
    lines: int
    errors: tuple[tuple[int, str], ...]
    text: Cut
    note: str = ""


def logs_of(evidences: Sequence[Evidence]) -> tuple[Log, ...]:
    """Return the log of the build, and the output and log messages of the node in each trial.

    Logs with errors come first.
    """
    logs = []
    build = evidences[0].build
    # All trials share the space on the page.
    size = Size(HEAD_BYTES // len(evidences), TAIL_BYTES // len(evidences), ERROR_BYTES)
    if build is not None:
        note = f"colcon ended with exit code {build.exit_code}." if build.exit_code else ""
        logs.append(_log("build", "Output of colcon build", build.log, size, note))
    for number, evidence in enumerate(evidences):
        recording = evidence.run.recording
        if recording is None:
            continue
        end = f"-{number}" if number else ""
        node = f"the node {evidence.trial.executable}" if len(evidences) > 1 else "the node"
        for key, title, output in (
            ("stderr", f"Output of {node} on stderr", recording.stderr),
            ("stdout", f"Output of {node} on stdout", recording.stdout),
        ):
            logs.append(_log(key + end, title, output.text, size, _dropped(output)))
        logged = "\n".join(f"{line.t_s:7.2f} s  {line.level:5}  {line.logger}: {line.text}" for line in recording.log)
        beside = f" while {evidence.trial.executable} ran" if len(evidences) > 1 else ""
        logs.append(_log("rosout" + end, f"Messages on /rosout{beside}, in order of arrival", logged, size))
    return tuple(sorted((log for log in logs if log.lines), key=lambda log: not log.errors))


def _log(key: str, title: str, text: str, room: Size, note: str = "") -> Log:
    text = text.rstrip("\n")
    lines = text.count("\n") + 1 if text.strip() else 0
    return Log(key, title, lines, tuple(errors_in(text, room.errors)), cut(text, room.head, room.tail), note)


def _dropped(output: Output) -> str:
    were = "was" if output.dropped == 1 else "were"
    return f"{count(output.dropped, 'more byte')} {were} written but not kept." if output.dropped else ""


def errors_in(text: str, room: int = ERROR_BYTES) -> list[tuple[int, str]]:
    """Return the lines that look like errors, with complete tracebacks, up to the limits for a page.

    Line numbers start at 1.
    """
    searched = text[-LOOKED_AT:]
    first = text.count("\n", 0, len(text) - len(searched)) + 1
    found: list[tuple[int, str]] = []
    inside = False
    for number, line in enumerate(searched.split("\n"), first):
        head = line[:2000]
        if BEGINS in head:
            inside = True
        if inside or ERROR.search(head):
            shown = plain_line(line)
            room -= size(shown) + 12
            if room < 0 or len(found) >= MOST_ERRORS:
                break
            found.append((number, shown))
        # A traceback ends at the first line without indentation.
        if inside and BEGINS not in head and not line.startswith((" ", "\t")):
            inside = False
    return found
