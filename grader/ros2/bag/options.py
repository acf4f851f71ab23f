"""Options of several verbs of `ros2 bag`, and checks of their values."""

from __future__ import annotations

import argparse
import math
import re
from pathlib import Path
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    from collections.abc import Iterable

STORAGES = ("mcap", "sqlite3")
LEVELS = ("debug", "info", "warn", "error", "fatal")


def add_bag(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of a verb that reads a bag."""
    parser.add_argument("bag_path", type=existing_path, help="the bag: its folder, or one of its files")
    parser.add_argument(
        "-s",
        "--storage",
        default="",
        choices=STORAGES,
        help="the storage format of the bag (no effect, since it is detected)",
    )


def add_log_level(parser: argparse.ArgumentParser) -> None:
    """Add the option for the minimum level of the log messages that are printed."""
    parser.add_argument(
        "--log-level", default="info", choices=LEVELS, help="print messages of this level and above (default: info)"
    )


def existing_path(text: str) -> Path:
    """Convert an argument to an existing path, for argparse."""
    path = Path(text)
    try:
        there = path.exists()
    except OSError as error:
        message = f"Bag path '{text}' cannot be opened: {error.strerror}"
        raise argparse.ArgumentTypeError(message) from error
    if not there:
        message = f"Bag path '{text}' does not exist!"
        raise argparse.ArgumentTypeError(message)
    return path


def above_zero(text: str) -> float:
    """Convert an argument to a finite number above 0, for argparse."""
    value = _number(text)
    if value <= 0:
        message = f"{text} is not in the valid range (> 0.0)"
        raise argparse.ArgumentTypeError(message)
    return value


def not_negative(text: str) -> float:
    """Convert an argument to a finite number that is not negative, for argparse."""
    value = _number(text)
    if value < 0:
        message = f"Value {text} is less than zero."
        raise argparse.ArgumentTypeError(message)
    return value


def _number(text: str) -> float:
    try:
        value = float(text)
    except ValueError as error:
        message = f"{text} is not the valid type (float)"
        raise argparse.ArgumentTypeError(message) from error
    if not math.isfinite(value):
        message = f"{text} is not a finite number"
        raise argparse.ArgumentTypeError(message)
    return value


def absolute(names: Iterable[str]) -> list[str]:
    """Return the names of topics, each with a slash at the beginning."""
    return [name if name.startswith("/") else f"/{name}" for name in names]


def contains(topic: str, pattern: str) -> bool:
    """Return whether a regular expression matches any part of a topic's name. An empty expression matches no topic.

    Raises:
        Ros2Error: the pattern is not a regular expression.
    """
    try:
        return bool(pattern and re.search(pattern, topic))
    except (re.error, TypeError) as error:
        message = f"[ERROR] [ros2bag]: The regular expression '{pattern}' cannot be read: {error}"
        raise Ros2Error(message) from error
