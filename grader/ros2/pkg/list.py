"""The verb `pkg list`: all packages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros import index

if TYPE_CHECKING:
    import argparse


def add(_: argparse.ArgumentParser) -> None:
    """It has no arguments."""


def run(_: argparse.Namespace) -> int:
    """Print them, sorted."""
    for name in index.packages():
        print(name)
    return 0
