"""The verb `pkg prefix`: print the folder in which a package is installed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros import index
from grader.ros2 import unsourced
from grader.ros2.completion import completes, packages

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("package_name", help="name of the package"), packages)
    parser.add_argument("--share", action="store_true", help="print the share folder of the package instead")


def run(args: argparse.Namespace) -> int:
    """Print the prefix.

    Raises:
        Ros2Error: the package is not installed.
    """
    unsourced.find(args.package_name, "Package not found")
    prefix = index.prefix_of(args.package_name, "Package not found")
    print(prefix / "share" / args.package_name if args.share else prefix)
    return 0
