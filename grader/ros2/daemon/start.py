"""The verb `daemon start`: start the daemon."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    import argparse

_READY_S = 10.0
_POLL_S = 0.02


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("--debug", "-d", action="store_true", help="log the requests to this terminal")


def run(args: argparse.Namespace) -> int:
    """Start the daemon and wait until it responds.

    Raises:
        Ros2Error: the daemon does not respond.
    """
    from grader.ros2.daemon import client

    if client.is_running():
        print("The daemon is already running")
        return 0
    client.start(debug=args.debug)
    end = time.monotonic() + _READY_S
    while not client.is_running():
        if time.monotonic() >= end:
            message = "Timed out waiting for daemon to become ready"
            raise Ros2Error(message)
        time.sleep(_POLL_S)
    print("The daemon has been started")
    return 0
