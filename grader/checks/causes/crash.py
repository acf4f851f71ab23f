"""The exception that crashed a student's node, read from its stderr."""

from __future__ import annotations

import re
import signal
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from grader.common.words import shorten
from grader.evidence.activity import ended_at_start
from grader.submission.code import import_path
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from grader.evidence.evidence import Evidence

START = "Traceback (most recent call last):"
IGNORED = "Exception ignored in"
"""Python prints this line before the traceback of an exception that it ignores, such as an exception in a
destructor."""
PACKAGES = ("site-packages", "dist-packages")
"""Folders of installed modules. A module next to setup.py is installed directly into one of these folders."""
FRAME = re.compile(r'\s*File "(?P<file>[^"]*)", line (?P<line>\d{1,7})(?:, in (?P<function>.*))?')
ERROR = re.compile(r"(?P<type>[A-Za-z_][\w.]*)(?:: (?P<message>.*))?")
MOST_LINE = 2000
"""The maximum length of the line with an exception (characters). The rest of a longer line is ignored: with a message
of 200,000 characters, the patterns that look for causes would take longer than the reader may."""
MOST_NAME = 100
"""The maximum length of the name of an exception (characters)."""
GUESS = re.compile(r" \(/[^)]*\)$|\.? Did you mean: .*| The following argument types are supported:.*")
"""Matches a path, a suggestion or a list of types at the end of an exception message. These parts are removed, because
they may differ between machines."""
STOPS = frozenset({"KeyboardInterrupt", "ExternalShutdownException"})
"""The exceptions that Ctrl-C raises in a node that is written as in the tutorial."""

RCLPY_ERRORS = frozenset({"InvalidNodeNameException", "InvalidTopicNameException", "NotInitializedException"})
"""The exceptions of rclpy that explain a mistake better than the first exception of a chain."""

MEANINGS = {
    "AssertionError": "An assertion failed: a condition was false, or a message field got a value of the wrong type.",
    "AttributeError": "The object has no such attribute, or the attribute cannot be assigned. Check the name.",
    "EOFError": "input() waits for the keyboard, but the grader does not type. A node must not ask for input.",
    "FileNotFoundError": "No file has this path. A relative path begins at the folder where the program started.",
    "ImportError": "Python could not do this import. The message of the exception gives the reason.",
    "IndentationError": "All lines of a block must have the same indentation.",
    "IndexError": "The sequence, such as a list or a string, has no item with this index.",
    "InvalidNodeNameException": "A node name has only letters, digits and underscores. It does not begin with a digit.",
    "InvalidQoSProfileException": "A QoSProfile needs a depth, which is the size of the queue.",
    "InvalidParameterException": "The name of a parameter is not valid, for example because it is empty.",
    "InvalidParameterValueException": "The value is outside the range of the parameter, or a callback refused it.",
    "InvalidServiceNameException": "In a service name, use only letters, digits, underscores and slashes.",
    "InvalidTopicNameException": "In a topic name, use only letters, digits, underscores and slashes.",
    "InvalidParameterTypeException": "A parameter has the type of its default value: 2 is an integer, 2.0 is a float.",
    "KeyError": "The dictionary has no such key, or the set has no such item.",
    "ModuleNotFoundError": "No module with that name is installed. Check the name letter by letter.",
    "NameError": "This name has no value here. Check the spelling of the name, and the imports.",
    "NotInitializedException": "ROS 2 was used before rclpy.init or after rclpy.shutdown.",
    "ParameterNotDeclaredException": "Declare a parameter with declare_parameter before you read or set it.",
    "OverflowError": "A number is too large for this operation.",
    "RecursionError": "A function calls itself again and again, directly or through another function.",
    "SyntaxError": "Python cannot read this line or the line before it.",
    "TabError": "The indentation mixes tabs and spaces.",
    "TypeError": "An operation or a function got a value of the wrong type, or the wrong number of arguments.",
    "ValueError": "A value has the right type, but it is not allowed here.",
    "ZeroDivisionError": "A number was divided by zero.",
}


@dataclass(frozen=True)
class Crash:
    """An exception in the student's node.

    `error` is the exception's class or, without an exception, the signal, the exit code or the exceeded limit. `where`
    is the last line of the student's own code in the traceback (or in another traceback of the chain, if this one has
    no such line). `callers` are the other lines of this code in the traceback, the nearest caller first.
    """

    error: str
    message: str
    where: Where | None = None
    callers: tuple[Where, ...] = field(default=(), compare=False)

    @property
    def observed(self) -> str:
        """The exception with its message, without a final full stop, such as 'ZeroDivisionError: division by zero'."""
        return f"{self.error}: {shorten(self.message.rstrip(' :.'), 90)}" if self.message else self.error

    @property
    def meaning(self) -> str:
        """The usual meaning of the exception, or an empty string if the meaning is unknown."""
        if self.error == "AssertionError" and "field must be of type 'float'" in self.message:
            return "This field is a float. Write the number with a decimal point."
        return MEANINGS.get(self.error, "")


def crash_of(evidence: Evidence) -> Crash | None:
    """Return the crash that made the node exit before the end of the scenario, or None."""
    end = evidence.recording.end
    if end.out_of is not None:
        return Crash(f"it used all the {end.out_of} that a node may use", "")
    if end.by != "itself":
        return None
    # A crashed node does not always exit with Python's exit code, so the traceback decides.
    found = read_traceback(evidence.recording.stderr.text, evidence.submission.files)
    if found is not None or end.exit_code == 0:
        return found
    if end.exit_code < 0:
        return Crash(_signal_name(-end.exit_code), "")
    return Crash(f"exit code {end.exit_code}", "")


def ended_early(evidence: Evidence) -> str:
    """Return a sentence saying that the node exited before the end of the scenario, or an empty string.

    The sentence contains neither the time nor the exception message, because a cause must not differ from run to run.
    """
    if evidence.recording.end.by != "itself":
        return ""
    crash = crash_of(evidence)
    if crash is None:
        return "The node exited on its own."
    place = f" at {crash.where}" if crash.where is not None else ""
    return f"The node crashed: {crash.error}{place}."


def end_observed(evidence: Evidence) -> str:
    """Return a sentence saying when the node exited before the end of the scenario, or an empty string."""
    end = evidence.recording.end
    if end.by != "itself":
        return ""
    when = "at startup" if ended_at_start(evidence.recording) else f"after {end.t_s:.1f} s"
    crash = crash_of(evidence)
    return f"The node exited on its own {when}." if crash is None else f"The node crashed {when}: {crash.observed}."


def read_traceback(text: str, files: Mapping[str, bytes]) -> Crash | None:
    """Return the last exception in stderr, or None.

    In a chain of exceptions, those that Ctrl-C caused do not count. Of the others, return the first that
    is in RCLPY_ERRORS, or the first of all if none is.
    """
    last: list[Crash] = []
    for chained, crash in read_tracebacks(text, files):
        last = [*last, crash] if chained else [crash]
    roots = [crash for crash in last if crash.error not in STOPS]
    if not roots:
        return None
    # An exception of rclpy explains a mistake best. The first traceback of a chain may contain no line of student code.
    root = next((crash for crash in roots if crash.error in RCLPY_ERRORS), roots[0])
    return replace(root, where=root.where or next((crash.where for crash in last if crash.where is not None), None))


def read_tracebacks(text: str, files: Mapping[str, bytes]) -> Iterable[tuple[bool, Crash]]:
    """Yield the exceptions in stderr as pairs (chained, exception), except those that Python ignored.

    `chained` is true if the exception belongs to the same chain as the previous exception.
    """
    for chained, lines in _blocks(text.splitlines()):
        crash = _crash(lines, files)
        if crash is not None:
            yield chained, crash


def _blocks(lines: list[str]) -> Iterable[tuple[bool, list[str]]]:
    """Yield the tracebacks as pairs (chained, lines without the first line).

    `chained` is true if the traceback belongs to the same chain of exceptions as the previous traceback. Exceptions
    that Python ignored are skipped, because they did not crash the node.
    """
    starts = [index for index, line in enumerate(lines) if line.strip() == START]
    for index, start in enumerate(starts):
        stop = starts[index + 1] if index + 1 < len(starts) else len(lines)
        if start and lines[start - 1].startswith(IGNORED):
            continue
        before = " ".join(lines[max(start - 3, 0) : start])
        chained = "another exception occurred" in before or "the direct cause of the following" in before
        yield chained, lines[start + 1 : stop]


def _crash(lines: list[str], files: Mapping[str, bytes]) -> Crash | None:
    places: list[Where] = []
    for line in lines:
        frame = FRAME.match(line)
        if frame is not None:
            own = _own_file(frame["file"], files)
            places += [] if own is None else [Where(own, int(frame["line"]))]
        elif line and not line[0].isspace():
            error = ERROR.fullmatch(line[:MOST_LINE])
            if error is None:
                return None
            message = GUESS.sub("", error["message"] or "").strip()
            where = places.pop() if places else None
            kind = error["type"].rpartition(".")[2][:MOST_NAME]
            return Crash(kind, message, where, tuple(reversed(places)))
    return None


def _own_file(path: str, files: Mapping[str, bytes]) -> str | None:
    """Return the submission file that was installed or linked at this path (the longest match), or None."""
    tail = f"/{path}"
    ends = [
        file
        for file in files
        if tail.endswith((f"/{file}", f"/{import_path(file)}")) and ("/" in file or _is_beside(path))
    ]
    return max(ends, key=len) if ends else None


def _is_beside(path: str) -> bool:
    """Return whether the path can belong to a file next to setup.py rather than to another package such as rclpy."""
    folders = path.split("/")[:-1]
    return not any(name in folders for name in PACKAGES) or folders[-1] in PACKAGES


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
