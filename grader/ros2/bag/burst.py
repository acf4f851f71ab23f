"""The verb `bag burst`: publish the first messages of a bag, or all of them, as fast as possible."""

from __future__ import annotations

import argparse
import math

from grader.ros2.bag.options import add_bag, add_log_level, not_negative


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_bag(parser)
    parser.add_argument("--read-ahead-queue-size", type=int, default=1000, help=argparse.SUPPRESS)
    parser.add_argument("--topics", default=[], metavar="topic", nargs="+", help="publish only these topics")
    parser.add_argument("--remap", "-m", default=[], nargs="+", help="publish on other topics: /old:=/new")
    parser.add_argument(
        "--start-offset", type=not_negative, default=0.0, help="start this many seconds into the bag (default: 0)"
    )
    parser.add_argument(
        "-n",
        "--num-messages",
        type=not_negative,
        default=0,
        help="pause after this number of messages; SPACE resumes (default: 0, all messages)",
    )
    add_log_level(parser)
    # Values for the options of `bag play` that `bag burst` does not have.
    parser.set_defaults(
        rate=1.0,
        regex="",
        exclude_regex="",
        exclude_topics=[],
        loop=False,
        clock=0.0,
        delay=0.0,
        playback_duration=-1.0,
        playback_until_sec=-1.0,
        disable_keyboard_controls=False,
        start_paused=True,
    )


def run(args: argparse.Namespace) -> int:
    """Publish the messages until the end of the bag or Ctrl-C.

    Raises:
        Ros2Error: an option is invalid, the path is not a bag, the bag is damaged, or none of its topics can be
            published.
    """
    from grader.ros2.bag.play import play

    return play(args, burst=args.num_messages or math.inf)
