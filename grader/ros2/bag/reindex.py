"""The verb `bag reindex`: restore a bag after an interrupted recording."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error
from grader.ros2.bag.options import add_bag

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_bag(parser)


def run(args: argparse.Namespace) -> int:
    """Restore the metadata, and repair the end of an incomplete file.

    Raises:
        Ros2Error: the path is not the folder of a bag, or its files cannot be read.
    """
    if not args.bag_path.is_dir():
        message = "[ERROR] [ros2bag]: Must specify a bag directory"
        raise Ros2Error(message)
    from grader.ros2.bag.recovery import recover

    recover(args.bag_path)
    return 0
