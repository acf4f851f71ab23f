"""Names in the graph: hidden names, types, and completion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable

    from rclpy.node import Node


def hidden(name: str) -> bool:
    """Return whether a name is meant only for tools, which is the case if a part of it begins with "_"."""
    return any(part.startswith("_") for part in name.split("/"))


def absolute(name: str) -> str:
    """Return the full name, which begins with a slash."""
    return name if name.startswith("/") else f"/{name}"


def shown(found: Iterable[tuple[str, list[str]]], *, all_of_them: bool) -> list[tuple[str, list[str]]]:
    """Return the names with their types, sorted. Hidden names are included only if `all_of_them` is true."""
    return sorted((name, types) for name, types in found if all_of_them or not hidden(name))


def nodes(node: Node, *, all_of_them: bool = False) -> list[str]:
    """Return the full names of the nodes, sorted. Hidden nodes are included only if `all_of_them` is true.

    If several nodes have the same name, the list contains this name several times.
    """
    found = [f"{namespace.rstrip('/')}/{name}" for name, namespace in node.get_node_names_and_namespaces()]
    return sorted(name for name in found if all_of_them or not hidden(name))


def add_wait(parser: argparse.ArgumentParser) -> None:
    """Add the discovery options of the real `ros2`. --no-daemon has no effect, since these verbs use no daemon."""
    parser.add_argument("--no-daemon", action="store_true", help="has no effect: the daemon is not used")
    parser.add_argument("--spin-time", type=float, metavar="S", help="wait at most this long for the graph")


def completed(kind: str) -> Any:  # noqa: ANN401
    """Return a completer for the names of one kind: "topic", "service", "node" or "action"."""

    def names(**_: Any) -> list[str]:  # noqa: ANN401
        from grader.graph.discovery import cli_node, settle

        with cli_node() as node:
            settle(node)
            if kind == "node":
                return nodes(node)
            if kind == "action":
                from rclpy.action import get_action_names_and_types

                return [name for name, _ in get_action_names_and_types(node)]
            found = node.get_topic_names_and_types() if kind == "topic" else node.get_service_names_and_types()
            return [name for name, _ in shown(found, all_of_them=False)]

    return names
