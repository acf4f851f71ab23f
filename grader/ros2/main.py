"""The command `ros2`: hands over to a sourced ROS 2's own, sees to the environment, and calls the verb.

Everything here is light: what a verb needs of rclpy is imported when it runs.
"""

from __future__ import annotations

import argparse
import os
import re
import signal
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, NoReturn

from grader.errors import GraderError
from grader.ros.failure import did_you_mean
from grader.ros.start import hand_over, see_to_environment

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from types import FrameType

GROUPS = ("action", "interface", "node", "param", "pkg", "run", "service", "topic")
INTERRUPTED = 2
"""Exit code after Ctrl-C, as the real one's."""


class Parser(argparse.ArgumentParser):
    """argparse's, with the nearest word where a choice is wrong."""

    def error(self, message: str) -> NoReturn:
        """Print what is wrong and end with exit code 2."""
        match = re.search(r"invalid choice: '([^']*)' \(choose from (.*)\)", message)
        choices = re.findall(r"[\w-]+", match[2]) if match else []
        super().error(did_you_mean(match[1], choices, message) if match else message)


def main() -> NoReturn:
    """Run `ros2` and end the process with its exit code."""
    code = run()
    with suppress(OSError):
        sys.stderr.flush()
    # The verb has cleaned up after itself: its node has left. Taking Python and rclpy apart would take as long as
    # importing them.
    os._exit(code)


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
        parser = make_parser()
        if "_ARGCOMPLETE" in os.environ:
            import argcomplete

            argcomplete.autocomplete(parser, always_complete_options=False)
        args = parser.parse_args(arguments)
        code: int = args.verb(args)
        sys.stdout.flush()
    except GraderError as error:
        sys.stdout.flush()
        if str(error):
            print(error, file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        _forget_the_terminal()
        return INTERRUPTED
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


def make_parser() -> argparse.ArgumentParser:
    """The parser of all groups and verbs; each ends in a function `verb(args) -> exit code`."""
    import importlib

    parser = Parser(prog="ros2", description="The commands of ROS 2 that this course uses, on the real rclpy.")
    parser.set_defaults(verb=_help_of(parser))
    groups = parser.add_subparsers(title="Commands", metavar="COMMAND", parser_class=Parser)
    for name in GROUPS:
        module = importlib.import_module(f"grader.ros2.{name}")
        about = (module.__doc__ or "").partition(": ")[2].partition("\n")[0]
        group = groups.add_parser(name, help=about, description=about)
        group.set_defaults(verb=_help_of(group))
        module.add(group)
    return parser


def _help_of(parser: argparse.ArgumentParser) -> Callable[[argparse.Namespace], int]:
    def print_help(_: argparse.Namespace) -> int:
        parser.print_help()
        return 0

    return print_help


def _end(number: int, _: FrameType | None) -> None:
    """End as after Ctrl-C, so that others see the node leave; a second signal ends it at once."""
    signal.signal(number, signal.SIG_DFL)
    raise KeyboardInterrupt


def _forget_the_terminal() -> None:
    """Let what is still in the buffer go nowhere: nobody reads it any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


if __name__ == "__main__":
    main()
