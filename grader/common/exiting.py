"""Run the command `grader`, and exit with its exit code. An error is printed as a sentence, not as a traceback."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, NoReturn

from grader.common.interrupts import raise_lost_stops
from grader.common.quick_exit import QuickExit
from grader.common.system_errors import refusal
from grader.common.terminal_text import RED, say
from grader.errors import GraderError

if TYPE_CHECKING:
    from collections.abc import Callable


def run_and_exit(command: Callable[[], object], explain: Callable[[Exception], str | None]) -> NoReturn:
    """Run the command, and exit. Decision 9 in docs/design.md lists the exit codes.

    `explain` is called for an error that is not one of the grader's own errors. It returns a sentence for the user, or
    None for an error that it cannot explain.
    """
    raise_lost_stops()
    try:
        _run(command)
        QuickExit.code = 0
        sys.exit(0)
    except GraderError as error:
        say(f"grader: {error}", style=RED)
        _drop_unwritten()
        sys.exit(error.exit_code)
    except KeyboardInterrupt:
        sys.exit(130)
    except BrokenPipeError:
        # The process at the other end of the pipe has exited, as in `grader check | head`.
        _discard(1, 2)
        sys.exit(1)
    except Exception as error:
        if os.environ.get("GRADER_DEBUG"):
            raise
        refused = explain(error) or refusal(error)
        if refused:
            say(f"grader: {refused}")
            _drop_unwritten()
            sys.exit(3)
        reported = (
            f"grader: internal error in the grader, not a problem with your work: {type(error).__name__}: {error}"
        )
        say(
            f"{reported}\nPut GRADER_DEBUG=1 before the command to see where the error happened. "
            "Please report the error."
        )
        sys.exit(3)


def _run(command: Callable[[], object]) -> None:
    try:
        command()
    except SystemExit as end:
        # If the output could not be written, Python would otherwise find out at exit, and exit with code 120.
        sys.stdout.flush()
        QuickExit.code = end.code
        raise


def _drop_unwritten() -> None:
    """Write the remaining output, or discard it if it cannot be written.

    If the output were kept, Python would try to write it at exit, fail, and exit with code 120.
    """
    try:
        sys.stdout.flush()
    except OSError:
        _discard(1)


def _discard(*numbers: int) -> None:
    for number in numbers:
        os.dup2(os.open(os.devnull, os.O_WRONLY), number)
