"""The command `ros2`: hands over to a sourced ROS 2's own, sees to the environment, and runs the verb.

Everything here is light: what a verb needs of rclpy is imported when it runs.
"""

from __future__ import annotations

import io
import os
import signal
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, NoReturn

from grader.errors import GraderError
from grader.ros.start import hand_over, see_to_environment
from grader.ros2.parser import make_parser

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FrameType


class _EndedError(KeyboardInterrupt):
    """A signal asked for the end."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number


def main() -> NoReturn:
    """Run `ros2` and end the process with its exit code."""
    code = run()
    with suppress(OSError):
        sys.stderr.flush()
    # The verb has cleaned up after itself: its node has left. Taking Python and rclpy apart would take as long as
    # importing them.
    os._exit(code & 0xFF)


def run(arguments: Sequence[str] | None = None) -> int:
    """Run `ros2`; returns the exit code, with nothing left in the buffer of standard output."""
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) == signal.SIG_DFL:
            signal.signal(number, _end)
    try:
        hand_over("ros2", "ros2cli")
        see_to_environment({"rclpy", "turtlesim"})
        # What is wrong with a value is then said by its name, before it is sent.
        os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")
        code = _run_verb(sys.argv[1:] if arguments is None else list(arguments))
        sys.stdout.flush()
    except GraderError as error:
        sys.stdout.flush()
        if str(error):
            print(error, file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt as error:
        _forget_the_terminal()
        # As the real one: 2 after Ctrl-C, 15 after SIGTERM.
        return error.number if isinstance(error, _EndedError) else signal.SIGINT
    except BrokenPipeError:
        # Whoever read us has gone, as in `ros2 topic echo | head`.
        _forget_the_terminal()
        return 0
    except Exception as error:
        if os.environ.get("GRADER_DEBUG"):
            raise
        fault = f"ros2: a fault of the course's ros2, not of yours: {type(error).__name__}: {error}"
        print(f"{fault}\nGRADER_DEBUG=1 before the command shows where; please report that.", file=sys.stderr)
        return 3
    return code


def _run_verb(words: list[str]) -> int:
    if "_ARGCOMPLETE" in os.environ:
        _complete()
    args = make_parser(words).parse_args(words)
    if not args.use_python_default_buffering and isinstance(sys.stdout, io.TextIOWrapper):
        # As the real one: what is piped into another program arrives line by line.
        sys.stdout.reconfigure(line_buffering=True)
    code: int = args.run(args)
    return code


def _complete() -> NoReturn:
    """Print what the word may become on which the Tab key was pressed, and end."""
    import argcomplete
    from argcomplete.lexers import split_line

    _, _, _, words, _ = split_line(os.environ["COMP_LINE"], int(os.environ["COMP_POINT"]))
    argcomplete.autocomplete(make_parser(words[1:]), always_complete_options=False)
    sys.exit(1)


def _end(number: int, _: FrameType | None) -> None:
    """End as after Ctrl-C, so that others see the node leave; a second signal ends it at once."""
    signal.signal(number, signal.SIG_DFL)
    raise _EndedError(number)


def _forget_the_terminal() -> None:
    """Let what is still in the buffer go nowhere: nobody reads it any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


if __name__ == "__main__":
    main()
