"""The verb `param get`: print the value of a parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.param.options import add_name, add_node, add_timeout

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_node(parser)
    add_name(parser)
    parser.add_argument("--hide-type", action="store_true", help="print only the value")
    add_timeout(parser)


def run(args: argparse.Namespace) -> int:
    """Print the value.

    Raises:
        Ros2Error: the node or the parameter does not exist, or the node does not respond.
    """
    from grader.ros2.param.parameter_client import parameters_of, value_text

    with parameters_of(args) as parameters:
        value = parameters.get(args.parameter_name)
        if value is None:
            raise Ros2Error(did_you_mean(args.parameter_name, parameters.names(), "Parameter not set"))
        print(value_text(value, hide_type=args.hide_type))
    return 0
