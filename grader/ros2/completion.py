"""Completers for the Tab key: names in the graph, and names of installed packages and types."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from grader.ros import index

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from grader.graph.graph_info import Look


def completes(argument: argparse.Action, names: Callable[..., Iterable[str]]) -> None:
    """Set the completer of an argument. `names` is called with `parsed_args`, the arguments before the cursor."""
    argument.completer = lambda **words: list(names(**words))  # type: ignore[attr-defined]


def _look() -> Look:
    from grader.ros2.graph_source import look

    return look(argparse.Namespace())


def topics(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """Return the names of the topics in the graph. Hidden ones need --include-hidden-topics."""
    return _look().topic_names(all_of_them=getattr(parsed_args, "include_hidden_topics", False))


def services(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """Return the names of the services in the graph. Hidden ones need --include-hidden-services."""
    return _look().service_names(all_of_them=getattr(parsed_args, "include_hidden_services", False))


def nodes(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """Return the names of the nodes in the graph. Hidden ones need --include-hidden-nodes or --include-hidden."""
    options = ("include_hidden_nodes", "include_hidden")
    return _look().node_names(all_of_them=any(getattr(parsed_args, each, False) for each in options))


def actions(**_: Any) -> list[str]:  # noqa: ANN401
    """Return the names of the actions in the graph."""
    return [name for name, _ in _look().actions]


def topic_types(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """Return the type of the topic on the command line if this topic exists, and otherwise all message types."""
    return _types(_look().topics, parsed_args.topic_name) or index.all_interfaces("msg")


def service_types(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """Return the type of the service on the command line if this service exists, and otherwise all service types."""
    return _types(_look().services, parsed_args.service_name) or index.all_interfaces("srv")


def action_types(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """Return the type of the action on the command line if this action exists, and otherwise all action types."""
    return _types(_look().actions, parsed_args.action_name) or index.all_interfaces("action")


def message_types(**_: Any) -> list[str]:  # noqa: ANN401
    """Return all installed message types."""
    return index.all_interfaces("msg")


def all_service_types(**_: Any) -> list[str]:  # noqa: ANN401
    """Return all installed service types."""
    return index.all_interfaces("srv")


def all_action_types(**_: Any) -> list[str]:  # noqa: ANN401
    """Return all installed action types."""
    return index.all_interfaces("action")


def interfaces(**_: Any) -> list[str]:  # noqa: ANN401
    """Return all installed messages, services and actions."""
    return index.all_interfaces()


def packages(**_: Any) -> list[str]:  # noqa: ANN401
    """Return all installed packages."""
    return list(index.packages())


def prototype(type_argument: str, kind: str, part: str = "") -> Callable[..., list[str]]:
    """Return a completer that offers all fields with their default values, as in "{linear: {x: 0.0, ...}, ...}".

    `type_argument` is the name of the argument that specifies the type. `part` is the part of the type to fill in, such
    as "Request" or "Goal".
    """

    def offered(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
        from grader.ros import message_values, rendering

        made = message_values.load_type(getattr(parsed_args, type_argument), kind)
        return [rendering.on_one_line((getattr(made, part) if part else made)())]

    return offered


def _types(found: Iterable[tuple[str, tuple[str, ...]]], name: str) -> list[str]:
    return [kind for known, kinds in found if known == name for kind in kinds]
