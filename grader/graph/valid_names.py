"""Names in the graph that ROS 2 accepts. Any program in the domain can also announce other names, through DDS.

rclpy raises an error if one of its functions gets such a name. Therefore, without a filter, one program could stop
every command that looks at the graph.
"""

from __future__ import annotations

import os
import re
import traceback
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rclpy.node import Node

from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    Named = list[tuple[str, list[str]]]

_FULL_NAME = re.compile(r"(?:/[A-Za-z_][A-Za-z0-9_]*)+")
_LONGEST = 247
"""The maximum length of a full topic name (RMW_TOPIC_MAX_NAME_LENGTH)."""


def is_valid(full_name: str) -> bool:
    """Return whether ROS 2 accepts the full name of a node, topic, service or action."""
    return len(full_name) <= _LONGEST and _FULL_NAME.fullmatch(full_name) is not None


def valid(found: Iterable[tuple[str, list[str]]]) -> Named:
    """Return the names that are valid, with their types."""
    return [(name, types) for name, types in found if is_valid(name)]


class ObservingNode(Node):  # type: ignore[misc]
    """A node whose lists of all nodes, topics and services contain only valid names."""

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Return the name and the namespace of each node."""
        found = super().get_node_names_and_namespaces()
        return [(name, space) for name, space in found if is_valid(f"{space.rstrip('/')}/{name}")]

    def get_topic_names_and_types(self, no_demangle: bool = False) -> Named:
        """Return the topics with their types."""
        return valid(super().get_topic_names_and_types(no_demangle))

    def get_service_names_and_types(self) -> Named:
        """Return the services with their types."""
        return valid(super().get_service_names_and_types())


@contextmanager
def readable_names() -> Iterator[None]:
    """Raise a clear error if rclpy cannot read the graph because of a name that is not valid UTF-8.

    Raises:
        Ros2Error: a name in the graph is not valid UTF-8.
    """
    try:
        yield
    except UnicodeDecodeError as error:
        *_, where = traceback.extract_tb(error.__traceback__)
        if "rclpy" not in Path(where.filename).parts:
            raise  # for example, a file that is not UTF-8
        domain = os.environ.get("ROS_DOMAIN_ID") or "0"
        message = (
            f"A program in ROS domain {domain} has a name in the graph that is not valid UTF-8, so ROS 2 cannot read "
            "the graph. Stop this program, or choose another domain: export ROS_DOMAIN_ID=NUMBER"
        )
        raise Ros2Error(message) from error
