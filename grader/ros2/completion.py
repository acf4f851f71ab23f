"""What the Tab key offers for a word: names of the running graph, and of what is installed."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from grader.ros import index

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from grader.graph.look import Look


def completes(argument: argparse.Action, names: Callable[..., Iterable[str]]) -> None:
    """Let Tab complete an argument; `names` takes `parsed_args`, the words typed so far, as a keyword."""
    argument.completer = lambda **words: list(names(**words))  # type: ignore[attr-defined]


def _look() -> Look:
    from grader.ros2.looking import look

    return look(argparse.Namespace())


def topics(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """The topics that are there."""
    return _look().topic_names(all_of_them=getattr(parsed_args, "include_hidden_topics", False))


def services(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """The services that are there."""
    return _look().service_names(all_of_them=getattr(parsed_args, "include_hidden_services", False))


def nodes(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """The nodes that are there."""
    return _look().node_names(all_of_them=getattr(parsed_args, "include_hidden_nodes", False))


def actions(**_: Any) -> list[str]:  # noqa: ANN401
    """The actions that are there."""
    return [name for name, _ in _look().actions]


def topic_types(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """The type of the topic that was typed, if it is there; else all message types."""
    return _types(_look().topics, parsed_args.topic_name) or index.all_interfaces("msg")


def service_types(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """The type of the service that was typed, if it is there; else all service types."""
    return _types(_look().services, parsed_args.service_name) or index.all_interfaces("srv")


def action_types(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    """The type of the action that was typed, if it is there; else all action types."""
    return _types(_look().actions, parsed_args.action_name) or index.all_interfaces("action")


def message_types(**_: Any) -> list[str]:  # noqa: ANN401
    """All message types that are installed."""
    return index.all_interfaces("msg")


def all_service_types(**_: Any) -> list[str]:  # noqa: ANN401
    """All service types that are installed."""
    return index.all_interfaces("srv")


def all_action_types(**_: Any) -> list[str]:  # noqa: ANN401
    """All action types that are installed."""
    return index.all_interfaces("action")


def interfaces(**_: Any) -> list[str]:  # noqa: ANN401
    """All messages, services and actions that are installed."""
    return index.all_interfaces()


def packages(**_: Any) -> list[str]:  # noqa: ANN401
    """All packages that are installed."""
    return list(index.packages())


def prototype(type_argument: str, kind: str, part: str = "") -> Callable[..., list[str]]:
    """A completer that offers all fields with their default values: "{linear: {x: 0.0, ...}, ...}".

    `type_argument` is the argument that holds the type, `part` what of it is meant: "Request", "Goal".
    """

    def offered(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
        from grader.ros import rendering, values

        made = values.load_type(getattr(parsed_args, type_argument), kind)
        return [rendering.to_yaml((getattr(made, part) if part else made)(), rendering.Form(flow=True)).strip()]

    return offered


def _types(found: Iterable[tuple[str, tuple[str, ...]]], name: str) -> list[str]:
    return [kind for known, kinds in found if known == name for kind in kinds]
