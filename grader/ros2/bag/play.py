"""The verb `bag play`: publish the messages of a bag at the recorded intervals."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error
from grader.ros2.bag.options import above_zero, absolute, add_bag, add_log_level, contains, not_negative

if TYPE_CHECKING:
    from collections.abc import Iterable


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_bag(parser)
    parser.add_argument("--read-ahead-queue-size", type=int, default=1000, help=argparse.SUPPRESS)
    parser.add_argument(
        "-r", "--rate", type=above_zero, default=1.0, help="multiply the speed by this factor (default: 1.0)"
    )
    parser.add_argument("--topics", default=[], metavar="topic", nargs="+", help="play only these topics")
    parser.add_argument("-e", "--regex", default="", help="play only topics whose names match this regular expression")
    parser.add_argument(
        "-x", "--exclude-regex", default="", help="exclude topics whose names match this regular expression"
    )
    parser.add_argument("--exclude-topics", default=[], metavar="topic", nargs="+", help="exclude these topics")
    parser.add_argument(
        "-l",
        "--loop",
        action="store_true",
        help="restart at the end, until Ctrl-C",
    )
    parser.add_argument(
        "--remap",
        "-m",
        default=[],
        nargs="+",
        help="publish on other topics: /old:=/new",
    )
    parser.add_argument(
        "--clock",
        type=above_zero,
        nargs="?",
        const=40.0,
        default=0.0,
        help="publish the time of the recording on /clock, at this rate in Hz (40 if no number is given)",
    )
    parser.add_argument(
        "-d", "--delay", type=above_zero, default=0.0, help="wait this number of seconds before each playback"
    )
    parser.add_argument(
        "--playback-duration",
        type=float,
        default=-1.0,
        help="play only this number of seconds of the recording",
    )
    parser.add_argument(
        "--playback-until-sec",
        type=float,
        default=-1.0,
        help="play until this time (seconds since 1970)",
    )
    parser.add_argument("--disable-keyboard-controls", action="store_true", help="ignore the keyboard")
    parser.add_argument("-p", "--start-paused", action="store_true", help="start paused; SPACE resumes")
    parser.add_argument(
        "--start-offset",
        type=not_negative,
        default=0.0,
        help="start this many seconds into the bag (default: 0)",
    )
    parser.add_argument("--wait-for-all-acked", type=int, default=-1, metavar="TIMEOUT", help=argparse.SUPPRESS)
    add_log_level(parser)


def run(args: argparse.Namespace) -> int:
    """Play the bag until its end or Ctrl-C.

    Raises:
        Ros2Error: an option is invalid, the path is not a bag, the bag is damaged, or none of its topics can be
            published.
    """
    return play(args)


def play(args: argparse.Namespace, *, burst: float = 0) -> int:
    """Play the bag with these options. The first `burst` messages are published without waiting, even while paused.

    Raises:
        Ros2Error: an option is invalid, the path is not a bag, the bag is damaged, or none of its topics can be
            published.
    """
    rules = remapping(args.remap)
    from grader.graph.discovery import cli_node
    from grader.ros2.bag.bag_player import Player
    from grader.ros2.bag.bag_reader import open_bag

    with open_bag(args.bag_path) as reader, cli_node("rosbag2_player") as node:
        chosen = [one for one in reader.connections if wanted(args, one.topic)]
        Player(node, reader, chosen, rules, args, burst).run()
    return 0


def wanted(args: argparse.Namespace, topic: str) -> bool:
    """Return whether the options select a topic of the bag."""
    excluded = absolute(args.exclude_topics) + (["/clock"] if args.clock else [])
    if topic in excluded or contains(topic, args.exclude_regex):
        return False
    if args.topics or args.regex:
        return topic in absolute(args.topics) or contains(topic, args.regex)
    return True


def remapping(rules: Iterable[str]) -> dict[str, str]:
    """Return the new name of each topic, given rules such as "/pose:=/old_pose".

    Raises:
        Ros2Error: a rule does not have the form OLD:=NEW.
    """
    found = {}
    for rule in rules:
        old, sign, new = rule.partition(":=")
        if not (old and sign and new):
            message = f"[ERROR] [ros2bag]: '{rule}' is not a remapping; an example is /turtle1/pose:=/old_pose"
            raise Ros2Error(message)
        found[absolute([old])[0]] = absolute([new])[0]
    return found
