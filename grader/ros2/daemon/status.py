"""The verb `daemon status`: print whether the daemon is running."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse


def add(_: argparse.ArgumentParser) -> None:
    """Leave the parser unchanged, because the verb has no arguments."""


def run(_: argparse.Namespace) -> int:
    """Print whether the daemon is running. Return 0 whether or not the daemon is running."""
    from grader.ros2.daemon import client

    print("The daemon is running" if client.is_running() else "The daemon is not running")
    return 0
