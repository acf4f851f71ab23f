"""What the build and the node said, with what looks like an error first."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.report.plain import Cut, cut, plain_line, size

if TYPE_CHECKING:
    from grader.checks.evidence import Evidence
    from grader.recording import Output

HEAD_BYTES, TAIL_BYTES, ERROR_BYTES = 20_000, 14_000, 6_000
LOOKED_AT = 400_000
"""Characters of a log that are searched for errors, from its end."""
MOST_ERRORS = 40
ERROR = re.compile(r"\b(?:Traceback \(most|\w*Error\b|\w*Exception\b|error:|ERROR|FATAL|Failed\b)|\[ERROR\]")
BEGINS = "Traceback (most recent call last):"


@dataclass(frozen=True)
class Log:
    """One of the logs: `errors` are those of its lines that look like errors, with their numbers."""

    key: str
    title: str
    lines: int
    errors: tuple[tuple[int, str], ...]
    text: Cut
    note: str = ""


def logs_of(evidence: Evidence) -> tuple[Log, ...]:
    """The build's log, the node's output, what it logged; those with errors first."""
    logs = []
    build, recording = evidence.build, evidence.recording
    if build is not None:
        note = f"colcon ended with exit code {build.exit_code}." if build.exit_code else ""
        logs.append(_log("build", "What colcon said while it built", build.log, note))
    if recording is not None:
        for key, title, output in (
            ("stderr", "What the node wrote on stderr", recording.stderr),
            ("stdout", "What the node printed on stdout", recording.stdout),
        ):
            logs.append(_log(key, title, output.text, _dropped(output)))
        logged = "\n".join(f"{line.t_s:7.2f} s  {line.level:5}  {line.logger}: {line.text}" for line in recording.log)
        logs.append(_log("rosout", "What was logged on /rosout, by arrival", logged))
    return tuple(sorted((log for log in logs if log.lines), key=lambda log: not log.errors))


def _log(key: str, title: str, text: str, note: str = "") -> Log:
    text = text.rstrip("\n")
    lines = text.count("\n") + 1 if text.strip() else 0
    return Log(key, title, lines, tuple(errors_in(text)), cut(text, HEAD_BYTES, TAIL_BYTES), note)


def _dropped(output: Output) -> str:
    return f"{output.dropped} bytes more were written and not kept." if output.dropped else ""


def errors_in(text: str) -> list[tuple[int, str]]:
    """The lines that look like errors with their numbers from 1, tracebacks whole; not more than a page can take."""
    searched = text[-LOOKED_AT:]
    first = text.count("\n", 0, len(text) - len(searched)) + 1
    found: list[tuple[int, str]] = []
    inside, room = False, ERROR_BYTES
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
        # A traceback ends with the first line that is not indented.
        if inside and BEGINS not in head and not line.startswith((" ", "\t")):
            inside = False
    return found
