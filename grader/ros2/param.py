"""The group `param`: the parameters of nodes, to look at and to set."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from grader.graph.names import add_wait, completed

if TYPE_CHECKING:
    import argparse


def add(group: argparse.ArgumentParser) -> None:
    """Add the verbs."""
    verbs = group.add_subparsers(title="Verbs", metavar="VERB")

    parser = verbs.add_parser("list", help="the parameters of all nodes, or of one")
    _add_node(parser, nargs="?")
    parser.add_argument("--param-type", action="store_true", help="with their types")
    parser.set_defaults(verb=_list)

    parser = verbs.add_parser("get", help="the value of a parameter")
    _add_node(parser)
    parser.add_argument("parameter_name").completer = _names  # type: ignore[attr-defined]
    parser.add_argument("--hide-type", action="store_true", help="only the value")
    parser.set_defaults(verb=_get)

    parser = verbs.add_parser("set", help="set a parameter")
    _add_node(parser)
    parser.add_argument("parameter_name").completer = _names  # type: ignore[attr-defined]
    parser.add_argument("value", help="as YAML: 150, 1.5, true, text, [1, 2]")
    parser.set_defaults(verb=_set)

    parser = verbs.add_parser("describe", help="what parameters are for, and which values they take")
    _add_node(parser)
    parser.add_argument("parameter_names", nargs="+").completer = _names  # type: ignore[attr-defined]
    parser.set_defaults(verb=_describe)

    parser = verbs.add_parser("dump", help="all parameters of a node as YAML, as --params-file takes it")
    _add_node(parser)
    parser.set_defaults(verb=_dump)


def _add_node(parser: argparse.ArgumentParser, **options: Any) -> None:  # noqa: ANN401
    parser.add_argument("node_name", **options).completer = completed("node")  # type: ignore[attr-defined]
    add_wait(parser)


def _names(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    from grader.ros2.parameters import parameters_of

    with parameters_of(parsed_args.node_name, None) as client:
        return client.names()


def _list(args: argparse.Namespace) -> int:
    from grader.ros2 import parameters

    found = parameters.names_of_all(args.node_name, args.spin_time, types=args.param_type)
    for node, lines in found.items():
        if args.node_name is None:
            print(f"{node}:")
        for line in lines:
            print(f"  {line}")
    return 0


def _get(args: argparse.Namespace) -> int:
    from grader.ros2.parameters import parameters_of, told

    with parameters_of(args.node_name, args.spin_time) as client:
        print(told(client.get(args.parameter_name), hide_type=args.hide_type))
    return 0


def _set(args: argparse.Namespace) -> int:
    from grader.ros2.parameters import parameters_of

    with parameters_of(args.node_name, args.spin_time) as client:
        result = client.set(args.parameter_name, args.value)
    if result.successful:
        print("Set parameter successful" + (f": {result.reason}" if result.reason else ""))
    else:
        # Its exit code is 0 all the same, as the real one's.
        print("Setting parameter failed" + (f": {result.reason}" if result.reason else ""), file=sys.stderr)
    return 0


def _describe(args: argparse.Namespace) -> int:
    from grader.ros2.parameters import described, parameters_of

    with parameters_of(args.node_name, args.spin_time) as client:
        for descriptor in client.describe(args.parameter_names):
            print(described(descriptor))
    return 0


def _dump(args: argparse.Namespace) -> int:
    from grader.ros2.parameters import dumped, parameters_of

    with parameters_of(args.node_name, args.spin_time) as client:
        print(dumped(client.node_name, client.all_values()), end="")
    return 0
