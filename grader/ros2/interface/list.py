"""The verb `interface list`: print all interfaces, grouped by kind."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros import index
from grader.ros2.interface.interface_kinds import add_kinds, chosen

if TYPE_CHECKING:
    import argparse

_TITLES = {"msg": "Messages:", "srv": "Services:", "action": "Actions:"}


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_kinds(parser)


def run(args: argparse.Namespace) -> int:
    """Print the names of the interfaces, sorted."""
    for kind in chosen(args) or index.KINDS:
        print(_TITLES[kind])
        for name in index.all_interfaces(kind):
            print(f"    {name}")
    return 0
