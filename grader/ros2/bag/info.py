"""The verb `bag info`: print information about a bag."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any

from grader.ros2.bag.options import add_bag

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable
    from pathlib import Path

_INDENT = 19
_UNITS = ("B", "KiB", "MiB", "GiB", "TiB")


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_bag(parser)
    parser.add_argument("-t", "--topic-name", action="store_true", help="print only the names of the topics")
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="ignore -t; a full ROS 2 also prints more about services"
    )


def run(args: argparse.Namespace) -> int:
    """Print information about the bag.

    Raises:
        Ros2Error: the path is not a bag, or the bag is damaged.
    """
    from grader.ros2.bag.bag_reader import open_bag

    if args.topic_name and args.verbose:
        print(
            "Warning! You have set both the '-t' and '-v' parameters. The '-t' parameter will be ignored.",
            file=sys.stderr,
        )
    with open_bag(args.bag_path) as reader:
        if args.topic_name and not args.verbose:
            print("\n".join(dict.fromkeys(connection.topic for connection in reader.connections)))
        else:
            print(_text(reader, _files(args.bag_path), _bytes(args.bag_path)))
    return 0


def _files(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    return sorted(file for file in path.iterdir() if {".mcap", ".db3"} & set(file.suffixes))


def _bytes(path: Path) -> int:
    """Return the size of a file, or of all files of a bag: like rosbag2, count metadata.yaml, too."""
    files = [path] if path.is_file() else [file for file in path.iterdir() if file.is_file()]
    return sum(file.stat().st_size for file in files)


def _text(reader: Any, files: list[Path], size: int) -> str:  # noqa: ANN401
    empty = not reader.message_count
    start = 0 if empty else reader.start_time
    # The end time that rosbags reports is one nanosecond after the last message.
    end = start if empty else reader.end_time - 1
    storage = "sqlite3" if files and ".db3" in files[0].suffixes else "mcap"
    topics = [
        f"Topic: {one.topic} | Type: {one.msgtype} | Count: {one.msgcount} | Serialization Format: cdr"
        for one in reader.connections
    ]
    return "\n".join(
        [
            "",
            f"Files:             {_lines(file.name for file in files)}",
            f"Bag size:          {_size(size)}",
            f"Storage id:        {storage}",
            f"ROS Distro:        {reader.ros_distro or 'unknown'}",
            f"Duration:          {_seconds(end - start)}s",
            f"Start:             {_moment(start)}",
            f"End:               {_moment(end)}",
            f"Messages:          {reader.message_count}",
            f"Topic information: {_lines(topics)}",
            "Service:           0",
            "Service information: ",
        ]
    )


def _lines(texts: Iterable[str]) -> str:
    return f"\n{' ' * _INDENT}".join(texts)


def _size(size: float) -> str:
    unit = 0
    while size >= 1024 and unit < len(_UNITS) - 1:
        size /= 1024
        unit += 1
    return f"{size:.{1 if unit else 0}f} {_UNITS[unit]}"


def _seconds(nanoseconds: int) -> str:
    return f"{nanoseconds // 10**9}.{nanoseconds % 10**9:09}"


def _moment(nanoseconds: int) -> str:
    when = time.localtime(nanoseconds // 10**9)
    date = time.strftime("%b %e %Y %H:%M:%S", when)
    return f"{date}.{nanoseconds % 10**9:09} ({_seconds(nanoseconds)})"
