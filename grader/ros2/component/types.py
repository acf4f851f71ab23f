"""The verb `component types`: print the installed components, from the ament index."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros import index
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.completion import completes, packages

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    text = "name of the package (default: all packages)"
    completes(parser.add_argument("package_name", nargs="?", help=text), packages)


def run(args: argparse.Namespace) -> int:
    """Print the components.

    Raises:
        Ros2Error: the package is not installed.
    """
    known = index.packages()
    if args.package_name is not None and args.package_name not in known:
        text = f"Unable to find package '{args.package_name}'"
        raise Ros2Error(did_you_mean(args.package_name, known, text))
    for package, lines in index.contents("rclcpp_components").items():
        types = [line.partition(";")[0] for line in lines]
        if args.package_name is None:
            print("\n".join([package, *(f"  {kind}" for kind in types)]))
        elif package == args.package_name:
            print("\n".join(types))
    return 0
