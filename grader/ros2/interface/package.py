"""The verb `interface package`: print the interfaces of one package."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros import index
from grader.ros2.completion import completes
from grader.ros2.interface.interface_kinds import add_kinds, chosen

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_kinds(parser)
    name = parser.add_argument("package_name", help="name of the package, such as turtlesim")
    completes(name, lambda **_: index.interface_packages())


def run(args: argparse.Namespace) -> int:
    """Print the interfaces, sorted. Print nothing for a package without interfaces.

    Raises:
        Ros2Error: the package is not installed.
    """
    kinds = chosen(args) or index.KINDS
    for name in index.interfaces(args.package_name):
        if name.split("/")[1] in kinds:
            print(name)
    return 0
