"""The options for the output format of messages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros.rendering import TRUNCATED_AT, Form
from grader.ros2.options import unsigned_int

if TYPE_CHECKING:
    import argparse


def add_form(parser: argparse.ArgumentParser) -> None:
    """Add the options for the format, except `--csv`."""
    parser.add_argument(
        "--full-length", "-f", action="store_true", help="print long arrays, bytes and strings completely"
    )
    parser.add_argument(
        "--truncate-length",
        "-l",
        type=unsigned_int,
        default=TRUNCATED_AT,
        help=f"truncate arrays, bytes and strings to this number of elements (default: {TRUNCATED_AT})",
    )
    parser.add_argument("--no-arr", action="store_true", help="print the type of arrays, not their values")
    parser.add_argument("--no-str", action="store_true", help="print the length of strings, not their value")
    parser.add_argument(
        "--flow-style", action="store_true", help="print arrays on one line, as [1, 2] (not with --csv)"
    )


def form_of(args: argparse.Namespace) -> Form:
    """Return the format that the options select."""
    limit = None if args.full_length else args.truncate_length
    return Form(limit, arrays=not args.no_arr, strings=not args.no_str, flow=args.flow_style)
