"""The verb `daemon stop`: stop the daemon."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    import argparse

_ENDED_S = 10.0


def add(_: argparse.ArgumentParser) -> None:
    """Leave the parser unchanged, because the verb has no arguments."""


def run(_: argparse.Namespace) -> int:
    """Stop the daemon and wait until it has exited.

    Raises:
        Ros2Error: the daemon does not exit.
    """
    from grader.ros2.daemon import client

    if client.request("stop") is None:
        print("The daemon is not running")
        return 0
    if not client.wait_until_ended(_ENDED_S):
        message = "Timed out waiting for daemon to shutdown"
        raise Ros2Error(message)
    print("The daemon has been stopped")
    return 0
