"""The grader's exceptions. A message says what was observed and, where it helps, what was expected and what to do."""

from __future__ import annotations


class GraderError(Exception):
    """The base class of the grader's errors. A command exits with `exit_code` (docs/design.md, decision 9)."""

    exit_code = 3


class UsageError(GraderError):
    """The command, the path or the exercise is wrong."""

    exit_code = 2


class UnreadableError(UsageError):
    """A submission could not be read, which is the student's fault."""


class TooLargeError(UnreadableError):
    """A submission is too large or too deeply nested to be read."""


class MachineError(GraderError):
    """The grader or the machine is broken, which is never the student's fault."""


class DiskError(MachineError):
    """The disk to which the grader writes has failed, so no submission can be graded."""
