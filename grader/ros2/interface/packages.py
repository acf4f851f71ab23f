"""The verb `interface packages`: print the packages that have interfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros import index
from grader.ros2.interface.interface_kinds import add_kinds, chosen

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_kinds(parser)


def run(args: argparse.Namespace) -> int:
    """Print the packages, sorted. If several kinds are given, use the first of messages, services and actions."""
    kinds = chosen(args)[:1]
    for package in index.interface_packages():
        if not kinds or any(name.split("/")[1] in kinds for name in index.interfaces(package)):
            print(package)
    return 0
