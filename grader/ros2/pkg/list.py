"""The verb `pkg list`: all packages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros import index

if TYPE_CHECKING:
    import argparse


def add(_: argparse.ArgumentParser) -> None:
    """Add no arguments, since the verb has none."""


def run(_: argparse.Namespace) -> int:
    """Print the names of the packages, sorted."""
    for name in index.packages():
        print(name)
    return 0
