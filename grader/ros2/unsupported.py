"""Commands and verbs of `ros2` that need a full ROS 2.

Each of them prints what to use instead, or why it is not needed.
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    from typing import NoReturn

INSTEAD = {
    "launch": "Start each node in a separate terminal with: ros2 run PACKAGE EXECUTABLE",
    "security": "By default, the nodes of this course communicate only on this machine, so they need no keys.",
    "hello": "By default, the nodes of this course communicate only on this machine. Use: ros2 doctor",
    "load": "Start a single node with: ros2 run PACKAGE EXECUTABLE",
    "unload": "Stop a node with Ctrl-C in its terminal.",
    "standalone": "Start a single node with: ros2 run PACKAGE EXECUTABLE",
}
"""Maps each command or verb that is not supported to a sentence: what to use instead, or why it is not needed."""


def add(parser: argparse.ArgumentParser) -> None:
    """Accept any arguments."""
    parser.add_argument("argv", nargs=argparse.REMAINDER, help=argparse.SUPPRESS)
    parser.set_defaults(words=parser.prog)


def run(args: argparse.Namespace) -> NoReturn:
    """Print the message.

    Raises:
        Ros2Error: always.
    """
    message = f"`{args.words}` needs a full ROS 2: docs.ros.org/en/jazzy/Installation.html\n"
    raise Ros2Error(message + INSTEAD[args.words.split()[-1]])
