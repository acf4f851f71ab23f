"""Print the log messages of `ros2 bag` to standard error, in the format of rclcpp's logger."""

from __future__ import annotations

import sys
import time
from contextlib import suppress
from dataclasses import dataclass

from grader.ros2.bag.options import LEVELS

_COLOURS = {"WARN": "\033[33m", "ERROR": "\033[31m", "FATAL": "\033[31m"}


@dataclass(frozen=True)
class Logger:
    """Prints messages of a given level and above.

    Example:
        >>> Logger("rosbag2_recorder").info("Recording...")  # doctest: +SKIP
        [INFO] [1762000000.123456789] [rosbag2_recorder]: Recording...
    """

    name: str
    level: str = "info"

    def info(self, text: str) -> None:
        """Print an informational message."""
        self._say("INFO", text)

    def warn(self, text: str) -> None:
        """Print a warning."""
        self._say("WARN", text)

    def error(self, text: str) -> None:
        """Print an error."""
        self._say("ERROR", text)

    def _say(self, level: str, text: str) -> None:
        if LEVELS.index(level.lower()) < LEVELS.index(self.level):
            return
        seconds, nanoseconds = divmod(time.time_ns(), 10**9)
        line = f"[{level}] [{seconds}.{nanoseconds:09}] [{self.name}]: {text}"
        colour = _COLOURS.get(level, "") if sys.stderr.isatty() else ""
        # The bag must be completed even if the reader of the messages has exited.
        with suppress(BrokenPipeError):
            print(f"{colour}{line}\033[0m" if colour else line, file=sys.stderr, flush=True)
