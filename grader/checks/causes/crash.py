"""Crash: the exception that ended a student's node, read from what Python wrote to stderr."""

from __future__ import annotations

import re
import signal
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from grader.common.words import shorten
from grader.evidence.observed import ended_at_start
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from grader.evidence.evidence import Evidence

START = "Traceback (most recent call last):"
FRAME = re.compile(r'\s*File "(?P<file>[^"]*)", line (?P<line>\d{1,7})(?:, in (?P<function>.*))?')
ERROR = re.compile(r"(?P<type>[A-Za-z_][\w.]*)(?:: (?P<message>.*))?")
GUESS = re.compile(r" \(/[^)]*\)$|\.? Did you mean: .*| The following argument types are supported:.*")
"""What Python's versions add to an error in different words; a diagnosis names the nearest name itself."""
STOPS = frozenset({"KeyboardInterrupt", "ExternalShutdownException"})
"""How a node in the tutorial's shape is told of Ctrl-C."""

TOLD_BY_RCLPY = frozenset({"InvalidNodeNameException", "InvalidTopicNameException", "NotInitializedException"})

MEANINGS = {
    "AssertionError": "Something that the code, or a message field, takes for granted did not hold.",
    "AttributeError": "An object has no attribute or method of that name: compare it letter by letter.",
    "EOFError": "input() waits for somebody to type; here nobody does, so a node must not ask.",
    "ImportError": "That name cannot be imported from there: compare it letter by letter.",
    "IndentationError": "The lines of one block must be indented alike.",
    "IndexError": "A list is shorter than the index that was asked for.",
    "InvalidNodeNameException": "A node's name may hold letters, digits and underscores only.",
    "InvalidTopicNameException": "A topic's name may hold letters, digits, underscores and slashes only.",
    "KeyError": "A dictionary has no such key.",
    "ModuleNotFoundError": "No module of that name is installed: compare it letter by letter.",
    "NameError": "A name is used that was never defined: a typing error, or a missing import.",
    "NotInitializedException": "ROS 2 was used before rclpy.init, or after its shutdown.",
    "ParameterNotDeclaredException": "A parameter is declared, by declare_parameter, before it is read.",
    "SyntaxError": "Python cannot read that line, or the one before it.",
    "TabError": "Tabs and blanks are mixed in the indentation.",
    "TypeError": "A function got another number or kind of arguments than it takes.",
    "UnboundLocalError": "A name is used before it gets a value.",
    "ValueError": "An argument has the right kind and a value that is not allowed.",
    "ZeroDivisionError": "A number was divided by zero.",
}


@dataclass(frozen=True)
class Crash:
    """An exception of the student's node: `error` is its class, `where` their own last line on the way to it."""

    error: str
    message: str
    where: Where | None = None

    @property
    def seen(self) -> str:
        """The exception in a few words, as in 'ZeroDivisionError: division by zero'."""
        return f"{self.error}: {shorten(self.message, 90)}" if self.message else self.error

    @property
    def meaning(self) -> str:
        """What such an error usually means; empty where that is not known."""
        if self.error == "AssertionError" and "field must be of type 'float'" in self.message:
            return "This field is a float: write the number with a decimal point."
        return MEANINGS.get(self.error, "")


def crash_of(evidence: Evidence) -> Crash | None:
    """What ended the node before the scenario was over; None when it ended well, or at Ctrl-C."""
    end = evidence.recording.end
    if end.out_of is not None:
        return Crash(f"it used up the {end.out_of} that a node may use", "")
    if end.by != "itself":
        return None
    # What a crashed node leaves as its exit code is not always what Python gave it: its last words count.
    found = read_traceback(evidence.recording.stderr.text, evidence.submission.files)
    if found is not None or end.exit_code == 0:
        return found
    if end.exit_code < 0:
        return Crash(_signal_name(-end.exit_code), "")
    return Crash(f"exit code {end.exit_code}", "")


def ended_early(evidence: Evidence) -> str:
    """A cause in words: the node ended before the scenario was over; empty when it did not.

    Without the time and the exception's message, since those may differ from run to run, and a cause must not.
    """
    if evidence.recording.end.by != "itself":
        return ""
    crash = crash_of(evidence)
    if crash is None:
        return "The node ended by itself."
    place = f" at {crash.where}" if crash.where is not None else ""
    return f"The node crashed: {crash.error}{place}."


def end_seen(evidence: Evidence) -> str:
    """What was seen of a node that ended before the scenario was over, with the time; empty when it did not."""
    end = evidence.recording.end
    if end.by != "itself":
        return ""
    when = "at its start" if ended_at_start(evidence.recording) else f"after {end.t_s:.1f} s"
    crash = crash_of(evidence)
    return f"The node ended by itself {when}." if crash is None else f"The node crashed {when}: {crash.seen}."


def read_traceback(text: str, files: Mapping[str, bytes]) -> Crash | None:
    """The root of the last exception in a stderr: where exceptions are chained, the first one that is no Ctrl-C."""
    last: list[Crash] = []
    for chained, crash in read_tracebacks(text, files):
        last = [*last, crash] if chained else [crash]
    roots = [crash for crash in last if crash.error not in STOPS]
    if not roots:
        return None
    # rclpy says best what was wrong; and the first part of a chain need not have a line of the student's in it.
    root = next((crash for crash in roots if crash.error in TOLD_BY_RCLPY), roots[0])
    return replace(root, where=root.where or next((crash.where for crash in last if crash.where is not None), None))


def read_tracebacks(text: str, files: Mapping[str, bytes]) -> Iterable[tuple[bool, Crash]]:
    """Every exception in a text, and whether it happened while the one before it was handled."""
    for chained, lines in _blocks(text.splitlines()):
        crash = _crash(lines, files)
        if crash is not None:
            yield chained, crash


def _blocks(lines: list[str]) -> Iterable[tuple[bool, list[str]]]:
    """Each traceback's lines after its first, and whether it happened while another one was handled."""
    starts = [index for index, line in enumerate(lines) if line.strip() == START]
    for index, start in enumerate(starts):
        stop = starts[index + 1] if index + 1 < len(starts) else len(lines)
        before = " ".join(lines[max(start - 3, 0) : start])
        chained = "another exception occurred" in before or "the direct cause of the following" in before
        yield chained, lines[start + 1 : stop]


def _crash(lines: list[str], files: Mapping[str, bytes]) -> Crash | None:
    where: Where | None = None
    for line in lines:
        frame = FRAME.match(line)
        if frame is not None:
            own = _own_file(frame["file"], files)
            where = where if own is None else Where(own, int(frame["line"]))
        elif line and not line[0].isspace():
            error = ERROR.fullmatch(line)
            if error is None:
                return None
            message = GUESS.sub("", error["message"] or "").strip()
            return Crash(error["type"].rpartition(".")[2], message, where)
    return None


def _own_file(path: str, files: Mapping[str, bytes]) -> str | None:
    """The submission's file that was installed or linked at this path: the longest one that ends it."""
    tail = f"/{path}"
    ends = [file for file in files if tail.endswith(f"/{file}")]
    return max(ends, key=len) if ends else None


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
