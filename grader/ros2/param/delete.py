"""The verb `param delete`: delete a parameter if the node allows it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros2.param.options import add_name, add_node, add_timeout

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_node(parser)
    add_name(parser)
    add_timeout(parser)


def run(args: argparse.Namespace) -> int:
    """Delete the parameter. Return 0 even if the node refuses to delete the parameter.

    Raises:
        Ros2Error: the node does not exist or does not respond.
    """
    from grader.ros2.param.parameter_client import not_set, parameters_of
    from grader.ros2.param.set import report

    with parameters_of(args) as parameters:
        wanted = not_set(args.parameter_name)
        report(parameters, wanted, "Deleted parameter successfully", "Deleting parameter failed")
    return 0
