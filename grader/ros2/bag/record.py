"""The verb `bag record`: record the messages on topics in a new bag."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.words import a_list
from grader.ros.failure import Ros2Error
from grader.ros2.bag.options import STORAGES, absolute, add_log_level, contains
from grader.ros2.completion import completes, message_types, topics

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.ros2.bag.bag_writer import BagWriter
    from grader.ros2.bag.split_writer import SplitWriter

_SELECTS = ("all", "all_topics", "topic_types", "regex")
_PROFILES = {"none": "none", "fastwrite": "none", "zstd_fast": "storage", "zstd_small": "storage"}
"""The preset profiles of the MCAP storage, each with its compression mode."""
NOT_HERE = (
    "services",
    "all_services",
    "exclude_services",
    "snapshot_mode",
    "storage_config_file",
    "qos_profile_overrides_path",
    "custom_data",
)
"""The options that this `ros2 bag record` does not support. docs/ros2-differences.md gives the reasons."""


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "-o",
        "--output",
        help="the new folder (default: in the current folder, named rosbag2_ and the time)",
    )
    parser.add_argument(
        "-s", "--storage", default="mcap", choices=STORAGES, help="storage format of the bag (default: mcap)"
    )
    _add_topics(parser)
    _add_discovery(parser)
    parser.add_argument("-f", "--serialization-format", default="", choices=("", "cdr"), help=argparse.SUPPRESS)
    _add_splitting(parser)
    parser.add_argument("--start-paused", action="store_true", help="start paused; SPACE starts the recording")
    parser.add_argument(
        "--use-sim-time",
        action="store_true",
        help="stamp messages with the time from /clock; nothing is recorded before the first message on /clock",
    )
    parser.add_argument(
        "--node-name", default="rosbag2_recorder", help="name of the recording node (default: rosbag2_recorder)"
    )
    parser.add_argument("--disable-keyboard-controls", action="store_true", help="ignore the keyboard")
    add_log_level(parser)
    parser.add_argument(
        "--storage-preset-profile",
        default="none",
        choices=sorted(_PROFILES),
        help="settings for writing the file (default: none)",
    )
    parser.add_argument(
        "--compression-mode",
        default="none",
        choices=("none", "file", "message"),
        help="unit of compression (default: none)",
    )
    parser.add_argument("--compression-format", default="", choices=("", "zstd"), help="compression format")
    for name in NOT_HERE:
        parser.add_argument(f"--{name.replace('_', '-')}", nargs="*", help=argparse.SUPPRESS)


def _add_topics(parser: argparse.ArgumentParser) -> None:
    named = parser.add_mutually_exclusive_group()
    positional = named.add_argument(
        "topics_positional",
        default=[],
        metavar="[Topic ...]",
        nargs="*",
        help="topics to record (deprecated: use --topics)",
    )
    completes(positional, topics)
    completes(
        named.add_argument("--topics", default=[], metavar="Topic", nargs="+", help="topics to record"),
        topics,
    )
    completes(
        parser.add_argument(
            "--topic-types",
            nargs="+",
            default=[],
            metavar="TopicType",
            help="record the topics of these types",
        ),
        message_types,
    )
    parser.add_argument("-a", "--all", action="store_true", help="record all topics except hidden ones")
    parser.add_argument("--all-topics", action="store_true", help="record all topics except hidden ones")
    parser.add_argument("-e", "--regex", default="", help="record the topics whose names match this regular expression")
    parser.add_argument("--exclude-regex", default="", help="exclude topics whose names match this regular expression")
    parser.add_argument(
        "--exclude-topic-types",
        default=[],
        metavar="ExcludeTopicTypes",
        nargs="+",
        help="exclude topics of these types",
    )
    parser.add_argument(
        "--exclude-topics",
        default=[],
        metavar="Topic",
        nargs="+",
        help="exclude these topics",
    )


def _add_splitting(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "-b",
        "--max-bag-size",
        type=int,
        default=0,
        help="maximum total size of the messages in a file, in bytes (default: 0, only one file)",
    )
    parser.add_argument(
        "-d",
        "--max-bag-duration",
        type=int,
        default=0,
        help="start a new file after this number of seconds (default: 0, only one file)",
    )


def _add_discovery(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--include-unpublished-topics",
        action="store_true",
        help="also record topics without a publisher",
    )
    parser.add_argument("--include-hidden-topics", action="store_true", help="also record hidden topics")
    parser.add_argument(
        "--no-discovery",
        action="store_true",
        help="record only the topics that exist at the start",
    )
    parser.add_argument(
        "-p",
        "--polling-interval",
        type=int,
        default=100,
        help="interval between searches for new topics, in milliseconds (default: 100)",
    )
    parser.add_argument("--ignore-leaf-topics", action="store_true", help="exclude topics without subscriptions")


def run(args: argparse.Namespace) -> int:
    """Record until Ctrl-C.

    Raises:
        Ros2Error: the options are invalid or select no topic, the folder already exists, or the bag cannot be written.
    """
    folder = Path(args.output or time.strftime("rosbag2_%Y_%m_%d-%H_%M_%S"))
    args.topics = absolute(args.topics or args.topics_positional)
    _validate(args, folder)
    from grader.graph.discovery import cli_node
    from grader.ros2.bag.bag_recorder import Recorder

    compression = args.compression_mode if args.compression_mode != "none" else _PROFILES[args.storage_preset_profile]
    with (
        cli_node(args.node_name, use_sim_time=args.use_sim_time) as node,
        _writer(folder, args, compression) as writer,
    ):
        Recorder(node, writer, args, wanted(args)).run()
    return 0


def _writer(folder: Path, args: argparse.Namespace, compression: str) -> BagWriter | SplitWriter:
    from grader.ros2.bag.bag_writer import BagWriter
    from grader.ros2.bag.split_writer import SplitWriter

    size, duration_s = args.max_bag_size, args.max_bag_duration
    if not size and not duration_s:
        return BagWriter(folder, args.storage, compression)
    return SplitWriter(folder, args.storage, compression, most_bytes=size, most_s=duration_s)


def wanted(args: argparse.Namespace) -> Callable[[str, str], bool]:
    """Return a function that takes a topic and its type, and returns whether the options select the topic.

    Raises:
        Ros2Error: a regular expression is invalid.
    """
    for pattern in (args.regex, args.exclude_regex):
        contains("", pattern)
    others = absolute(args.exclude_topics)

    def holds(topic: str, kind: str) -> bool:
        if topic in others or kind in args.exclude_topic_types or contains(topic, args.exclude_regex):
            return False
        if args.all or args.all_topics or topic in args.topics or kind in args.topic_types:
            return True
        return contains(topic, args.regex)

    return holds


def _validate(args: argparse.Namespace, folder: Path) -> None:
    """Raise Ros2Error if the options cannot be used. If the real `ros2` has a message for the reason, use it."""
    selects = any(getattr(args, name) for name in _SELECTS)
    unknown = [f"--{name.replace('_', '-')}" for name in NOT_HERE if getattr(args, name) is not None]
    need = "needs" if len(unknown) == 1 else "need"
    rules: dict[str, object] = {
        f"{a_list(unknown)} {need} a full ROS 2; this is the course's own ros2 bag": unknown,
        "Need to specify at least one option out of --all, --all-topics, --all-services, --services, --topics, "
        "--topic-types or --regex": not selects and not args.topics,
        "--exclude-regex argument requires either --all, --all-topics, --topic-types, --all-services or "
        "--regex": args.exclude_regex and not selects,
        "--exclude-topics argument requires either --all, --all-topics, --topic-types or --regex": args.exclude_topics
        and not selects,
        "--exclude-topic-types argument requires either --all, --all-topics or --regex": args.exclude_topic_types
        and not selects,
        f"Output folder '{folder}' already exists.": folder.exists(),
        "--max-bag-size and --max-bag-duration must not be negative": min(args.max_bag_size, args.max_bag_duration) < 0,
        "--use-sim-time and --no-discovery both set, but are incompatible settings. The /clock topic needs to be "
        "discovered to record with sim time.": args.use_sim_time and args.no_discovery,
        "Invalid choice: Cannot specify compression format without a compression mode.": args.compression_format
        and args.compression_mode == "none",
        "The storage sqlite3 does not have this preset profile; use --compression-mode": args.storage == "sqlite3"
        and _PROFILES[args.storage_preset_profile] == "storage",
    }
    wrong = next((text for text, holds in rules.items() if holds), None)
    if wrong:
        message = f"[ERROR] [ros2bag]: {wrong}"
        raise Ros2Error(message)
