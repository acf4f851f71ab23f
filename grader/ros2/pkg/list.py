"""The verb `pkg list`: print all packages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros import index

if TYPE_CHECKING:
    import argparse


def add(_: argparse.ArgumentParser) -> None:
    """Leave the parser unchanged, because the verb has no arguments."""


def run(_: argparse.Namespace) -> int:
    """Print the names of the packages, sorted."""
    for name in index.packages():
        print(name)
    return 0
