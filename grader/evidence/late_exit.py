"""A node that crashed, but whose process took so long to exit that Ctrl-C was sent first.

On a busy machine, a trial in simulated time may end before a process with an uncaught exception has exited.
The same submission must always get the same outcomes. Therefore, the outcome depends on the exception, and not on
whether the process exited before or after Ctrl-C.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.trial.recording import Recording

START = "Traceback (most recent call last):"
TOP = re.compile(r'\s*File ".*", line \d+, in <module>')
"""Matches the outermost stack frame of a program. The traceback of an exception that a function of the program caught
does not contain this frame."""


def with_crash_first(recording: Recording) -> Recording:
    """Return the recording or, if the node raised an uncaught exception before Ctrl-C, a changed copy.

    In the copy, the node exited on its own at the time of the exception.
    """
    end, stderr = recording.end, recording.stderr
    if end.by == "itself" or end.out_of is not None:
        return recording
    lines = stderr.text.splitlines()
    for index, line in enumerate(lines[:-1]):
        if line == START and TOP.match(lines[index + 1]) and index < len(stderr.times):
            at_s = stderr.times[index]
            if at_s < recording.sigint_t_s:
                return replace(recording, end=replace(end, by="itself", exit_code=1, t_s=at_s, stop_s=None))
    return recording
