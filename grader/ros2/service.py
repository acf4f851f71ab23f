"""The group `service`: which services there are, and calling one."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any

from grader.graph.names import absolute, add_wait, completed, hidden, shown
from grader.ros import index
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.topic import above_zero

if TYPE_CHECKING:
    import argparse

    from rclpy.node import Node

_TOLD_EVERY_S = 1.0


def add(group: argparse.ArgumentParser) -> None:
    """Add the verbs."""
    verbs = group.add_subparsers(title="Verbs", metavar="VERB")

    parser = verbs.add_parser("list", help="all services")
    parser.add_argument("-t", "--show-types", action="store_true", help="with their types")
    parser.add_argument("-c", "--count-services", action="store_true", help="only how many there are")
    parser.add_argument("-a", "--include-hidden-services", action="store_true", help="the inside of actions too")
    add_wait(parser)
    parser.set_defaults(verb=_list)

    parser = verbs.add_parser("type", help="the type of a service")
    parser.add_argument("service_name").completer = completed("service")  # type: ignore[attr-defined]
    add_wait(parser)
    parser.set_defaults(verb=_type)

    parser = verbs.add_parser("find", help="the services of a type")
    parser.add_argument("service_type").completer = lambda **_: index.all_interfaces("srv")  # type: ignore[attr-defined]
    parser.add_argument("-c", "--count-services", action="store_true", help="only how many there are")
    parser.add_argument("-a", "--include-hidden-services", action="store_true", help="the inside of actions too")
    add_wait(parser)
    parser.set_defaults(verb=_find)

    parser = verbs.add_parser("call", help="call a service and print the answer")
    parser.add_argument("service_name").completer = completed("service")  # type: ignore[attr-defined]
    parser.add_argument("service_type").completer = lambda **_: index.all_interfaces("srv")  # type: ignore[attr-defined]
    parser.add_argument("values", nargs="?", default="{}", help='the request, as in "{x: 2.0}"; default: all zero')
    parser.add_argument("-r", "--rate", type=above_zero, metavar="HZ", help="again and again, so often a second")
    parser.set_defaults(verb=_call)


def _services(node: Node, *, all_of_them: bool = False) -> list[tuple[str, list[str]]]:
    return shown(node.get_service_names_and_types(), all_of_them=all_of_them)


def _list(args: argparse.Namespace) -> int:
    from grader.graph.discovery import cli_node, settle

    with cli_node() as node:
        settle(node, deadline_s=args.spin_time)
        found = _services(node, all_of_them=args.include_hidden_services)
    if args.count_services:
        print(len(found))
        return 0
    for name, types in found:
        print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return 0


def _type(args: argparse.Namespace) -> int:
    from grader.graph.discovery import cli_node, settle

    with cli_node() as node:
        settle(node, deadline_s=args.spin_time)
        found = dict(_services(node, all_of_them=True))
    types = found.get(args.service_name)
    if types is None:
        raise Ros2Error(did_you_mean(args.service_name, (name for name in found if not hidden(name))))
    print("\n".join(types))
    return 0


def _find(args: argparse.Namespace) -> int:
    from grader.graph.discovery import cli_node, settle

    with cli_node() as node:
        settle(node, deadline_s=args.spin_time)
        found = _services(node, all_of_them=args.include_hidden_services)
    names = [name for name, types in found if args.service_type in types]
    print(len(names)) if args.count_services else [print(name) for name in names]
    if not names and args.service_type not in index.all_interfaces("srv"):
        hint = did_you_mean(args.service_type, {name for _, types in found for name in types})
        if hint:
            print(hint, file=sys.stderr)
    return 0


def _call(args: argparse.Namespace) -> int:
    from grader.graph.discovery import cli_node, nap, settle, spin_until
    from grader.ros import values

    made = values.load_type(args.service_type, "srv", "service type")
    request = values.fill(made.Request(), values.parse(args.values))
    name = absolute(args.service_name)
    with cli_node() as node:
        client = node.create_client(made, name)
        settle(node, client.service_is_ready)
        if not client.service_is_ready():
            print("waiting for service to become available...", flush=True)
            _say_why(node, name, args.service_type)
            while not client.service_is_ready():
                time.sleep(0.02)
        while True:
            print(f"requester: making request: {request!r}\n", flush=True)
            asked = time.monotonic()
            future = client.call_async(request)
            spin_until(node, future.done)
            print(f"response:\n{future.result()!r}\n", flush=True)
            if args.rate is None:
                return 0
            nap(asked + 1 / args.rate - time.monotonic())


def _say_why(node: Any, name: str, asked: str) -> None:  # noqa: ANN401
    """Say what may be wrong when nobody answers: the type, or the name."""
    found = dict(_services(node))
    # Our own client is one of those who say what type it has.
    others = [kind for kind in found.pop(name, []) if kind != asked]
    hint = f"The service {name} has the type {', '.join(others)}." if others else did_you_mean(name, found)
    if hint:
        print(hint, file=sys.stderr, flush=True)
