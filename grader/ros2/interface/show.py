"""The verb `interface show`: print the definition of an interface."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, Any

from grader.ros2.completion import completes, interfaces
from grader.ros2.interface import definition

if TYPE_CHECKING:
    from collections.abc import Sequence


class _FromInput(argparse.Action):
    """An argparse action that stores the value, or the first line of standard input if the value is "-"."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[Any] | None,
        option_string: str | None = None,  # noqa: ARG002
    ) -> None:
        if values == "-":
            if sys.stdin.isatty():
                parser.error("expected stdin pipe")
            values = sys.stdin.readline().strip()
        if not values:
            parser.error("the passed value is empty")
        setattr(namespace, self.dest, values)


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    comments = parser.add_mutually_exclusive_group()
    comments.add_argument("--all-comments", action="store_true", help="also print the comments of nested types")
    comments.add_argument("--no-comments", action="store_true", help="print neither comments nor empty lines")
    kind = parser.add_argument(
        "type",
        action=_FromInput,
        help="full name, such as geometry_msgs/msg/Twist; - reads the type from standard input",
    )
    completes(kind, interfaces)


def run(args: argparse.Namespace) -> int:
    """Print the definition.

    Raises:
        Ros2Error: the interface, or the type of one of its fields, is not installed or cannot be read.
    """
    for line in definition.lines(args.type, comments=not args.no_comments, nested_comments=args.all_comments):
        print(line)
    return 0
