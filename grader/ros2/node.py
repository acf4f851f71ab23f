"""The group `node`: which nodes there are, and what one of them offers and uses."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from grader.graph.names import absolute, add_wait, completed, nodes, shown
from grader.ros.failure import Ros2Error, did_you_mean

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable

    from rclpy.node import Node

_SAME_NAME = (
    "WARNING: Be aware that there are nodes in the graph that share an exact name, which can have unintended side "
    "effects."
)


def add(group: argparse.ArgumentParser) -> None:
    """Add the verbs."""
    verbs = group.add_subparsers(title="Verbs", metavar="VERB")

    parser = verbs.add_parser("list", help="all nodes")
    parser.add_argument("-a", "--all", action="store_true", help="hidden ones too")
    parser.add_argument("-c", "--count-nodes", action="store_true", help="only how many there are")
    add_wait(parser)
    parser.set_defaults(verb=_list)

    parser = verbs.add_parser("info", help="topics, services and actions of a node")
    parser.add_argument("node_name").completer = completed("node")  # type: ignore[attr-defined]
    parser.add_argument("--include-hidden", action="store_true", help="the inside of actions too")
    add_wait(parser)
    parser.set_defaults(verb=_info)


def split(full_name: str) -> tuple[str, str]:
    """The name and the namespace of a full name: "/a/b" -> ("b", "/a")."""
    namespace, _, name = full_name.rpartition("/")
    return name, namespace or "/"


def require_node(node: Node, name: str, text: str) -> str:
    """The full name of a node that is there; `name` may lack its slash.

    Raises:
        Ros2Error: with `text` and the nearest name.
    """
    known = nodes(node, all_of_them=True)
    if absolute(name) not in known:
        raise Ros2Error(did_you_mean(name, nodes(node), text))
    return absolute(name)


def _list(args: argparse.Namespace) -> int:
    from grader.graph.discovery import cli_node, settle

    with cli_node() as node:
        settle(node, deadline_s=args.spin_time)
        found = nodes(node, all_of_them=args.all)
    if args.count_nodes:
        print(len(found))
        return 0
    if len(set(found)) < len(found):
        print(_SAME_NAME, file=sys.stderr)
    for name in found:
        print(name)
    return 0


def _info(args: argparse.Namespace) -> int:
    from rclpy.action import get_action_client_names_and_types_by_node, get_action_server_names_and_types_by_node

    from grader.graph.discovery import cli_node, settle

    with cli_node() as node:
        settle(node, deadline_s=args.spin_time)
        full = require_node(node, args.node_name, f"Unable to find node '{args.node_name}'")
        same = nodes(node, all_of_them=True).count(full)
        if same > 1:
            told = f'There are {same} nodes in the graph with the exact name "{full}".'
            print(f"{told} You are seeing information about only one of them.", file=sys.stderr)
        name, namespace = split(full)
        sections: list[tuple[str, Iterable[tuple[str, list[str]]]]] = [
            ("Subscribers", node.get_subscriber_names_and_types_by_node(name, namespace)),
            ("Publishers", node.get_publisher_names_and_types_by_node(name, namespace)),
            ("Service Servers", node.get_service_names_and_types_by_node(name, namespace)),
            ("Service Clients", node.get_client_names_and_types_by_node(name, namespace)),
            ("Action Servers", get_action_server_names_and_types_by_node(node, name, namespace)),
            ("Action Clients", get_action_client_names_and_types_by_node(node, name, namespace)),
        ]
    print(full)
    for title, found in sections:
        _print_section(title, shown(found, all_of_them=args.include_hidden))
    return 0


def _print_section(title: str, found: list[tuple[str, Any]]) -> None:
    print(f"  {title}:")
    print("\n".join(f"    {name}: {', '.join(types)}" for name, types in found))
