"""The verb `daemon status`: whether the daemon is running."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse


def add(_: argparse.ArgumentParser) -> None:
    """Add no arguments, since the verb has none."""


def run(_: argparse.Namespace) -> int:
    """Print whether the daemon is running; return 0 in both cases."""
    from grader.ros2.daemon import client

    print("The daemon is running" if client.is_running() else "The daemon is not running")
    return 0
