"""The group `topic`: which topics there are, what is on them, and publishing.

Its verbs that handle messages have modules of their own.
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from grader.graph.names import add_wait, completed, hidden, shown
from grader.ros import index
from grader.ros.failure import Ros2Error, did_you_mean

if TYPE_CHECKING:
    from rclpy.node import Node


def add(group: argparse.ArgumentParser) -> None:
    """Add the verbs."""
    verbs = group.add_subparsers(title="Verbs", metavar="VERB")
    _add_looks(verbs)
    _add_messages(verbs)


def _add_looks(verbs: Any) -> None:  # noqa: ANN401
    parser = verbs.add_parser("list", help="all topics")
    parser.add_argument("-t", "--show-types", action="store_true", help="with their types")
    parser.add_argument("-c", "--count-topics", action="store_true", help="only how many there are")
    parser.add_argument("-v", "--verbose", action="store_true", help="with how many publish and subscribe")
    parser.add_argument("-a", "--include-hidden-topics", action="store_true", help="the inside of actions too")
    add_wait(parser)
    parser.set_defaults(verb=_list)

    parser = verbs.add_parser("info", help="the type of a topic, and how many publish and subscribe")
    parser.add_argument("topic_name").completer = completed("topic")
    parser.add_argument("-v", "--verbose", action="store_true", help="each publisher and subscription, with its QoS")
    add_wait(parser)
    parser.set_defaults(verb=_info)

    parser = verbs.add_parser("type", help="the type of a topic")
    parser.add_argument("topic_name").completer = completed("topic")
    add_wait(parser)
    parser.set_defaults(verb=_type)

    parser = verbs.add_parser("find", help="the topics of a type")
    parser.add_argument("topic_type").completer = lambda **_: index.all_interfaces("msg")
    parser.add_argument("-c", "--count-topics", action="store_true", help="only how many there are")
    parser.add_argument("-a", "--include-hidden-topics", action="store_true", help="the inside of actions too")
    add_wait(parser)
    parser.set_defaults(verb=_find)


def _add_messages(verbs: Any) -> None:  # noqa: ANN401
    parser = verbs.add_parser("echo", help="print the messages on a topic")
    parser.add_argument("topic_name").completer = completed("topic")
    parser.add_argument("message_type", nargs="?").completer = lambda **_: index.all_interfaces("msg")
    parser.add_argument("--once", action="store_true", help="one message, then end")
    parser.add_argument("--csv", action="store_true", help="one line a message, commas between the values")
    parser.add_argument("--field", metavar="PATH", help="only this part, as in linear.x")
    parser.add_argument("-f", "--full-length", action="store_true", help="long arrays and texts whole")
    parser.add_argument("-l", "--truncate-length", type=int, default=128, metavar="N", help="else cut after N (128)")
    add_wait(parser)
    parser.set_defaults(verb=_echo)

    parser = verbs.add_parser("hz", help="how often messages arrive")
    parser.add_argument("topic_name").completer = completed("topic")
    parser.add_argument("-w", "--window", type=positive, default=10000, metavar="N", help="over the last N (10000)")
    add_wait(parser)
    parser.set_defaults(verb=_hz)

    parser = verbs.add_parser("pub", help="publish a message, once or again and again")
    parser.add_argument("topic_name").completer = completed("topic")
    parser.add_argument("message_type").completer = lambda **_: index.all_interfaces("msg")
    parser.add_argument("values", nargs="?", default="{}", help='as in "{linear: {x: 2.0}}"; default: all zero')
    parser.add_argument("-r", "--rate", type=above_zero, default=1.0, metavar="HZ", help="messages a second (1)")
    parser.add_argument("-p", "--print", type=positive, default=1, metavar="N", help="print every Nth (1)")
    times = parser.add_mutually_exclusive_group()
    times.add_argument("-1", "--once", action="store_true", help="one message, then end")
    times.add_argument("-t", "--times", type=positive, metavar="N", help="N messages, then end")
    parser.add_argument(
        "-w", "--wait-matching-subscriptions", type=int, metavar="N", help="wait for N (1 with --once, --times; else 0)"
    )
    parser.add_argument("-n", "--node-name", metavar="NAME", help="the name of the node that publishes")
    add_wait(parser)
    parser.set_defaults(verb=_pub)


def positive(text: str) -> int:
    """A whole number from 1 on, for argparse."""
    if not text.isdecimal() or int(text) == 0:
        message = f"a whole number above 0 was expected, not '{text}'"
        raise argparse.ArgumentTypeError(message)
    return int(text)


def above_zero(text: str) -> float:
    """A number above 0, for argparse."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        message = f"a number above 0 was expected, not '{text}'"
        raise argparse.ArgumentTypeError(message)
    return value


def unknown_topic(node: Node, name: str, text: str = "") -> Ros2Error:
    """The error about a topic that is not there, with the nearest one that is."""
    known = [topic for topic, _ in node.get_topic_names_and_types() if not hidden(topic)]
    return Ros2Error(did_you_mean(name, known, text))


def _types(node: Node, topic: str) -> list[str]:
    return next((types for name, types in node.get_topic_names_and_types() if name == topic), [])


def _list(args: argparse.Namespace) -> int:
    from grader.graph.discovery import cli_node, settle

    with cli_node() as node:
        settle(node, deadline_s=args.spin_time)
        found = shown(node.get_topic_names_and_types(), all_of_them=args.include_hidden_topics)
        if args.count_topics:
            print(len(found))
        elif args.verbose:
            _print_ends(
                "Published topics:", "publisher", [(*topic, node.count_publishers(topic[0])) for topic in found]
            )
            _print_ends(
                "Subscribed topics:", "subscriber", [(*topic, node.count_subscribers(topic[0])) for topic in found]
            )
        else:
            for name, types in found:
                print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return 0


def _print_ends(title: str, kind: str, topics: list[tuple[str, list[str], int]]) -> None:
    print(title)
    for name, types, count in topics:
        if count:
            print(f" * {name} [{', '.join(types)}] {count} {kind}{'' if count == 1 else 's'}")
    print()


def _info(args: argparse.Namespace) -> int:
    from grader.graph.discovery import cli_node, settle

    with cli_node() as node:
        settle(node, deadline_s=args.spin_time)
        name = args.topic_name
        types = _types(node, name)
        if not types:
            # The real one says nothing at all about a name without its slash.
            raise unknown_topic(node, name, f"Unknown topic '{name}'" if name.startswith("/") else "")
        print(f"Type: {types[0] if len(types) == 1 else types}")
        ends = (
            ("Publisher", node.get_publishers_info_by_topic),
            ("Subscription", node.get_subscriptions_info_by_topic),
        )
        for kind, get in ends:
            found = get(name)
            if not args.verbose:
                print(f"{kind} count: {len(found)}")
                continue
            print(f"\n{kind} count: {len(found)}")
            for end in found:
                print(f"\n{end}")
        if args.verbose:
            print()
    return 0


def _type(args: argparse.Namespace) -> int:
    from grader.graph.discovery import cli_node, settle

    with cli_node() as node:
        settle(node, deadline_s=args.spin_time)
        types = _types(node, args.topic_name)
        if not types:
            raise unknown_topic(node, args.topic_name)
        for name in types:
            print(name)
    return 0


def _find(args: argparse.Namespace) -> int:
    from grader.graph.discovery import cli_node, settle

    with cli_node() as node:
        settle(node, deadline_s=args.spin_time)
        found = shown(node.get_topic_names_and_types(), all_of_them=args.include_hidden_topics)
    names = [name for name, types in found if args.topic_type in types]
    if args.count_topics:
        print(len(names))
    else:
        for name in names:
            print(name)
    if not names:
        import sys

        hint = did_you_mean(args.topic_type, {name for _, types in found for name in types})
        if args.topic_type not in index.all_interfaces("msg") and hint:
            print(hint, file=sys.stderr)
    return 0


def _echo(args: argparse.Namespace) -> int:
    from grader.ros2.topic_echo import echo

    return echo(args)


def _hz(args: argparse.Namespace) -> int:
    from grader.ros2.topic_hz import hz

    return hz(args)


def _pub(args: argparse.Namespace) -> int:
    from grader.ros2.topic_pub import pub

    return pub(args)
