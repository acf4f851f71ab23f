"""What the grader raises. Every message is written for the person who reads it: seen, expected, what to do."""

from __future__ import annotations


class GraderError(Exception):
    """Base of all errors of the grader; `exit_code` is what a command ends with (docs/design.md, decision 9)."""

    exit_code = 3


class UsageError(GraderError):
    """The command, the path or the exercise is wrong."""

    exit_code = 2


class UnreadableError(UsageError):
    """What a student handed in could not be read: the student's fault."""


class TooLargeError(UnreadableError):
    """It is too large, or nested too deeply, to be read."""


class MachineError(GraderError):
    """The grader or the machine is broken: never the student's fault."""


class DiskError(MachineError):
    """The disk that the grader itself writes to has failed: no other submission would fare better."""
