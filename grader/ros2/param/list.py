"""The verb `param list`: print the names of the parameters of one node or of all nodes."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error
from grader.ros2.completion import completes, nodes
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse

    from grader.ros2.param.parameter_client import Parameters


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_look(parser)
    completes(parser.add_argument("node_name", nargs="?", help="name of a node (default: all nodes)"), nodes)
    parser.add_argument(
        "--filter", nargs=1, help="print only parameters whose names match this regular expression from the beginning"
    )
    parser.add_argument("--include-hidden-nodes", action="store_true", help="include nodes whose names start with _")
    parser.add_argument(
        "--param-prefixes", nargs="+", default=[], help="print only these parameters: the prefix a selects a and a.b"
    )
    parser.add_argument("--param-type", action="store_true", help="also print the types")


def run(args: argparse.Namespace) -> int:
    """Print the names of the parameters, sorted.

    Raises:
        Ros2Error: a node does not exist or does not respond, or the filter is not a regular expression.
    """
    from grader.graph.discovery import cli_node, settle
    from grader.ros2.param.parameter_client import Parameters, parameters_of, with_parameters

    if args.node_name:
        with parameters_of(args) as parameters:
            _print(parameters, args)
        return 0
    with cli_node(use_sim_time=args.use_sim_time) as node:
        settle(node, deadline_s=args.spin_time)
        for name in with_parameters(node, all_of_them=args.include_hidden_nodes):
            _print(Parameters(node, name), args, title=f"{name}:")
    return 0


def _print(parameters: Parameters, args: argparse.Namespace, title: str = "") -> None:
    from grader.ros2.param.parameter_client import type_name

    names = parameters.names(args.param_prefixes)
    if args.filter:
        try:
            wanted = re.compile(args.filter[0])
        except re.error as error:
            message = f"The filter '{args.filter[0]}' is not a regular expression: {error}"
            raise Ros2Error(message) from error
        names = [name for name in names if wanted.match(name)]
    if title and names:
        print(title)
    types = {one.name: type_name(one.type) for one in parameters.describe(names)} if args.param_type else {}
    for name in names:
        print(f"  {name} (type: {types.get(name, 'unknown')})" if args.param_type else f"  {name}")
