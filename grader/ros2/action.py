"""The group `action`: which actions there are, who offers them, and sending a goal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.names import add_wait, completed, nodes
from grader.ros import index
from grader.ros.failure import Ros2Error, did_you_mean

if TYPE_CHECKING:
    import argparse

    from rclpy.node import Node


def add(group: argparse.ArgumentParser) -> None:
    """Add the verbs."""
    verbs = group.add_subparsers(title="Verbs", metavar="VERB")

    parser = verbs.add_parser("list", help="all actions")
    parser.add_argument("-t", "--show-types", action="store_true", help="with their types")
    parser.add_argument("-c", "--count-actions", action="store_true", help="only how many there are")
    add_wait(parser)
    parser.set_defaults(verb=_list)

    parser = verbs.add_parser("info", help="who offers an action, and who uses it")
    parser.add_argument("action_name").completer = completed("action")  # type: ignore[attr-defined]
    parser.add_argument("-t", "--show-types", action="store_true", help="with their types")
    parser.add_argument("-c", "--count", action="store_true", help="only how many there are")
    add_wait(parser)
    parser.set_defaults(verb=_info)

    parser = verbs.add_parser("send_goal", help="send a goal and wait for its result")
    parser.add_argument("action_name").completer = completed("action")  # type: ignore[attr-defined]
    parser.add_argument("action_type").completer = lambda **_: index.all_interfaces("action")  # type: ignore[attr-defined]
    parser.add_argument("goal", help='as in "{theta: 1.57}"')
    parser.add_argument("-f", "--feedback", action="store_true", help="print the feedback")
    parser.set_defaults(verb=_send_goal)


def _list(args: argparse.Namespace) -> int:
    from rclpy.action import get_action_names_and_types

    from grader.graph.discovery import cli_node, settle

    with cli_node() as node:
        settle(node, deadline_s=args.spin_time)
        found = sorted(get_action_names_and_types(node))
    if args.count_actions:
        print(len(found))
        return 0
    for name, types in found:
        print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return 0


def _info(args: argparse.Namespace) -> int:
    from rclpy.action import (
        get_action_client_names_and_types_by_node,
        get_action_names_and_types,
        get_action_server_names_and_types_by_node,
    )

    from grader.graph.discovery import cli_node, settle

    with cli_node() as node:
        settle(node, deadline_s=args.spin_time)
        known = [name for name, _ in get_action_names_and_types(node)]
        if args.action_name not in known:
            raise Ros2Error(did_you_mean(args.action_name, known, f"Unknown action '{args.action_name}'"))
        ends = (
            ("clients", _users(node, args.action_name, get_action_client_names_and_types_by_node)),
            ("servers", _users(node, args.action_name, get_action_server_names_and_types_by_node)),
        )
    print(f"Action: {args.action_name}")
    for title, users in ends:
        print(f"Action {title}: {len(users)}")
        for name, types in users if not args.count else ():
            print(f"    {name} [{', '.join(types)}]" if args.show_types else f"    {name}")
    return 0


def _users(node: Node, action: str, get: object) -> list[tuple[str, list[str]]]:
    from grader.ros2.node import split

    assert callable(get)
    users = []
    for full in nodes(node, all_of_them=True):
        types = next((types for name, types in get(node, *split(full)) if name == action), None)
        if types is not None:
            users.append((full, types))
    return users


def _send_goal(args: argparse.Namespace) -> int:
    from grader.ros2.send_goal import send_goal

    return send_goal(args)
