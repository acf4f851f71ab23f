"""Options of several verbs of `param`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.ros2.completion import completes, nodes
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse


def add_node(parser: argparse.ArgumentParser) -> None:
    """Add the argument for the node, and the option for hidden nodes."""
    add_look(parser)
    completes(parser.add_argument("node_name", help="name of the node, such as /turtlesim"), nodes)
    parser.add_argument("--include-hidden-nodes", action="store_true", help="include nodes whose names start with _")


def add_timeout(parser: argparse.ArgumentParser) -> None:
    """Add the option for the maximum time to wait for the node."""
    parser.add_argument(
        "--timeout", metavar="N", type=int, default=1, help="wait at most N seconds for the node (default: 1)"
    )


def add_name(parser: argparse.ArgumentParser, name: str = "parameter_name", **options: Any) -> None:  # noqa: ANN401
    """Add the argument for the name of the parameter."""
    completes(parser.add_argument(name, help="name of the parameter, such as background_r", **options), _names)


def _names(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    from grader.ros2.param.parameter_client import parameters_of

    with parameters_of(parsed_args) as parameters:
        return parameters.names()
