"""The verb `pkg executables`: print the executables that `ros2 run` can start, in all packages or in one package."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros import index
from grader.ros2 import unsourced
from grader.ros2.completion import completes, packages

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("package_name", nargs="?", help="name of a package (default: all)"), packages)
    parser.add_argument("--full-path", action="store_true", help="print paths instead of names")


def run(args: argparse.Namespace) -> int:
    """Print the executables, sorted by package and path.

    Raises:
        Ros2Error: the package is not installed.
    """
    if args.package_name:
        unsourced.find(args.package_name, f"Package '{args.package_name}' not found")
    for package in [args.package_name] if args.package_name else index.packages():
        for path in index.executables(package, f"Package '{package}' not found"):
            print(path if args.full_path else f"{package} {path.name}")
    return 0
