"""The verb `topic list`: print the names of the topics."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.graph_info import shown
from grader.ros2.graph_source import look
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse

    from grader.graph.graph_info import Look, Named


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_look(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="also print the type of each topic")
    parser.add_argument("-c", "--count-topics", action="store_true", help="print only the number of topics")
    parser.add_argument("--include-hidden-topics", action="store_true", help="include hidden topics")
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="print the numbers of publishers and subscribers of each topic"
    )


def run(args: argparse.Namespace) -> int:
    """Print the sorted names of the topics, or their number. With --verbose, count their publishers and subscribers."""
    graph = look(args)
    found = shown(graph.topics, all_of_them=args.include_hidden_topics)
    if args.count_topics:
        print(len(found))
    elif args.verbose and found:
        _print_ends(graph, found, "Published topics:", "publisher", publishes=True)
        _print_ends(graph, found, "Subscribed topics:", "subscriber", publishes=False)
    else:
        for name, types in found:
            print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return 0


def _print_ends(graph: Look, topics: list[Named], title: str, kind: str, *, publishes: bool) -> None:
    print(title)
    for name, types in topics:
        count = len(graph.ends(name, publishes=publishes))
        if count:
            print(f" * {name} [{', '.join(types)}] {count} {kind}{'' if count == 1 else 's'}")
    print()
