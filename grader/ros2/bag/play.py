"""The verb `bag play`: publish the messages of a bag as they came."""

from __future__ import annotations

import argparse
import re
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error
from grader.ros2.bag.options import above_zero, absolute, add_bag, add_log_level, not_negative

if TYPE_CHECKING:
    from collections.abc import Iterable


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_bag(parser)
    parser.add_argument("--read-ahead-queue-size", type=int, default=1000, help=argparse.SUPPRESS)
    parser.add_argument(
        "-r", "--rate", type=above_zero, default=1.0, help="rate at which to play back messages. Valid range > 0.0."
    )
    parser.add_argument(
        "--topics", default=[], metavar="topic", nargs="+", help="Space-delimited list of topics to play."
    )
    parser.add_argument("-e", "--regex", default="", help="Play only topics matches with regular expression.")
    parser.add_argument("-x", "--exclude-regex", default="", help="regular expressions to exclude topics from replay.")
    parser.add_argument(
        "--exclude-topics", default=[], metavar="topic", nargs="+", help="Space-delimited list of topics not to play."
    )
    parser.add_argument(
        "-l",
        "--loop",
        action="store_true",
        help="enables loop playback when playing a bagfile: it starts back at the beginning on reaching the end and "
        "plays indefinitely.",
    )
    parser.add_argument(
        "--remap",
        "-m",
        default=[],
        nargs="+",
        help='list of topics to be remapped: in the form "old_topic1:=new_topic1 old_topic2:=new_topic2 etc." ',
    )
    parser.add_argument(
        "--clock",
        type=above_zero,
        nargs="?",
        const=40.0,
        default=0.0,
        help="Publish to /clock at a specific frequency in Hz, to act as a ROS Time Source. Defaults to not "
        "publishing.",
    )
    parser.add_argument(
        "-d", "--delay", type=above_zero, default=0.0, help="Sleep duration before play (each loop), in seconds."
    )
    parser.add_argument(
        "--playback-duration",
        type=float,
        default=-1.0,
        help="Playback duration, in seconds. Negative durations mark an infinite playback.",
    )
    parser.add_argument(
        "--playback-until-sec",
        type=float,
        default=-1.0,
        help="Playback until timestamp, expressed in seconds since epoch.",
    )
    parser.add_argument(
        "--disable-keyboard-controls", action="store_true", help="disables keyboard controls for playback"
    )
    parser.add_argument(
        "-p", "--start-paused", action="store_true", help="Start the playback player in a paused state."
    )
    parser.add_argument(
        "--start-offset",
        type=not_negative,
        default=0.0,
        help="Start the playback player this many seconds into the bag file.",
    )
    parser.add_argument("--wait-for-all-acked", type=int, default=-1, metavar="TIMEOUT", help=argparse.SUPPRESS)
    add_log_level(parser)


def run(args: argparse.Namespace) -> int:
    """Play it to its end, or until Ctrl-C.

    Raises:
        Ros2Error: it is not a bag, it is damaged, or no topic of it can be published here.
    """
    rules = remapping(args.remap)
    from grader.graph.discovery import cli_node
    from grader.ros2.bag.player import Player
    from grader.ros2.bag.reader import open_bag

    with open_bag(args.bag_path) as reader, cli_node("rosbag2_player") as node:
        chosen = [one for one in reader.connections if wanted(args, one.topic)]
        Player(node, reader, chosen, rules, args).run()
    return 0


def wanted(args: argparse.Namespace, topic: str) -> bool:
    """Whether the options choose a topic of the bag."""
    excluded = absolute(args.exclude_topics) + (["/clock"] if args.clock else [])
    if topic in excluded or (args.exclude_regex and re.search(args.exclude_regex, topic)):
        return False
    if args.topics or args.regex:
        return topic in absolute(args.topics) or bool(args.regex and re.search(args.regex, topic))
    return True


def remapping(rules: Iterable[str]) -> dict[str, str]:
    """The new name of each topic that is named in rules such as "/pose:=/old_pose".

    Raises:
        Ros2Error: a rule has not this form.
    """
    found = {}
    for rule in rules:
        old, sign, new = rule.partition(":=")
        if not (old and sign and new):
            message = f"[ERROR] [ros2bag]: '{rule}' is not a remapping; an example is /turtle1/pose:=/old_pose"
            raise Ros2Error(message)
        found[absolute([old])[0]] = absolute([new])[0]
    return found
