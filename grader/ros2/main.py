"""The command `ros2`: run the `ros2` of a sourced ROS 2 if there is one, and otherwise one of our verbs.

This module imports few modules, so that the command starts quickly. A verb imports parts of rclpy only when it runs.
"""

from __future__ import annotations

import io
import os
import signal
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, NoReturn

from grader.common.interrupts import raise_lost_stops
from grader.common.own_process import prepare
from grader.common.plain_output import protect_terminal
from grader.common.standard_streams import make_usable
from grader.common.system_errors import refusal
from grader.common.terminal_text import say
from grader.errors import GraderError
from grader.ros.startup import hand_over, see_to_environment
from grader.ros2.parser import make_parser

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FrameType

ENDS_S = 10
"""The maximum time that a command may take to leave the graph after SIGTERM or SIGHUP (s). After this time, an alarm
terminates the command."""


_stops: list[int] = []
"""The numbers of the signals that have interrupted the command."""


def main() -> NoReturn:
    """Run `ros2` and exit with its exit code."""
    make_usable()
    prepare()
    protect_terminal()
    raise_lost_stops()
    code = run()
    with suppress(OSError):
        sys.stderr.flush()
    # The verb has finished, and its node has left the graph. A normal exit of Python and rclpy would take as long as
    # their import.
    os._exit(code & 0xFF)


def run(arguments: Sequence[str] | None = None) -> int:
    """Run `ros2`, flush standard output, and return the exit code."""
    _stops.clear()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) in {signal.SIG_DFL, signal.default_int_handler}:
            signal.signal(number, _end)
    words = sys.argv[1:] if arguments is None else list(arguments)
    try:
        hand_over("ros2", "ros2cli")
        see_to_environment({"rclpy", "turtlesim"})
        # With this setting, an invalid value raises an error that names the field before the message is sent.
        os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")
        code = _run_verb(words)
        sys.stdout.flush()
    except GraderError as error:
        sys.stdout.flush()
        if str(error):
            _report(str(error))
            _report_slip(words)
        return error.exit_code
    except KeyboardInterrupt:
        return _interrupted()
    except BrokenPipeError:
        # The reader of the output has exited, as in `ros2 topic echo | head`.
        _forget_the_terminal()
        return 0
    except Exception as error:
        if _stops:
            # rclpy calls the constructor of a message from C++, and replaces a KeyboardInterrupt by a RuntimeError.
            return _interrupted()
        if os.environ.get("GRADER_DEBUG"):
            raise
        _forget_the_terminal()
        fault = f"ros2: an error in the course's ros2, not in your code: {type(error).__name__}: {error}"
        more = "Please report it. Put GRADER_DEBUG=1 before the command to see the traceback."
        _report(refusal(error) or f"{fault}\n{more}")
        return 3
    return code


def _interrupted() -> int:
    """Return the exit code of the real ros2: 2 after Ctrl-C, 15 after SIGTERM."""
    _forget_the_terminal()
    return _stops[-1] if _stops else signal.SIGINT


def _report(text: str) -> None:
    """Print to standard error, unless the terminal has been closed."""
    with suppress(OSError):
        say(text)


def _report_slip(words: Sequence[str]) -> None:
    """After an error, name a typographic dash or quotation mark, or missing quotation marks, if there are any."""
    from grader.common.typing_slips import hint

    found = hint(words)
    if found:
        _report(found)


def _run_verb(words: list[str]) -> int:
    if "_ARGCOMPLETE" in os.environ:
        _complete()
    if words[:1] != ["run"]:
        # No verb computes with numpy. A learner's own program, which `run` starts, may use all processors.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        args = make_parser(words).parse_args(words)
    except SystemExit as done:  # argparse has printed the help or an error
        if done.code:
            _report_slip(words)
        return int(done.code or 0)
    if not args.use_python_default_buffering and isinstance(sys.stdout, io.TextIOWrapper):
        # As in the real ros2, output to a pipe is flushed after each line.
        sys.stdout.reconfigure(line_buffering=True)
    code: int = args.run(args)
    return code


def _complete() -> NoReturn:
    """Print the completions of the word before the cursor, and exit."""
    import argcomplete
    from argcomplete.lexers import split_line

    _, _, _, words, _ = split_line(os.environ["COMP_LINE"], int(os.environ["COMP_POINT"]))
    argcomplete.autocomplete(make_parser(words[1:]), always_complete_options=False)
    sys.exit(1)


def _end(number: int, _: FrameType | None) -> None:
    """Raise a KeyboardInterrupt, so that the node leaves the graph. A second SIGTERM or SIGHUP terminates the process.

    The exception does not always end the process: Python discards it during `__del__`, and the middleware can block
    while the node is removed. If the terminal is closed, nobody sends a second signal. Therefore, an alarm terminates
    the process.
    """
    _stops.append(number)
    if number != signal.SIGINT:
        signal.signal(number, signal.SIG_DFL)
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.alarm(ENDS_S)
    raise KeyboardInterrupt


def _forget_the_terminal() -> None:
    """Ignore Ctrl-C from now on, and flush standard output. If this fails, discard the output."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        sys.stdout.flush()
    except OSError:
        with suppress(OSError):  # opening a file may be impossible
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


if __name__ == "__main__":
    main()
