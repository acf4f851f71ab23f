"""Names in the graph: hidden names, full names, and the names of all nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.node import Node


def hidden(name: str) -> bool:
    """Return whether a name is hidden (meant only for tools). A part of a hidden name begins with "_"."""
    return any(part.startswith("_") for part in name.split("/"))


def absolute(name: str) -> str:
    """Return the full name, which begins with a slash."""
    return name if name.startswith("/") else f"/{name}"


def nodes(node: Node, *, all_of_them: bool = False) -> list[str]:
    """Return the full names of the nodes, sorted. Hidden nodes are included only if `all_of_them` is true.

    As in the real `ros2`, a node is hidden if its own name begins with "_", also if its namespace does not.

    If several nodes have the same name, the list contains this name several times.
    """
    found = node.get_node_names_and_namespaces()
    return sorted(f"{space.rstrip('/')}/{name}" for name, space in found if all_of_them or not name.startswith("_"))
