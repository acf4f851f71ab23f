"""Helpers for verbs that subscribe to a topic: find its full name and type, and warn if it has no publishers."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from rclpy.exceptions import InvalidTopicNameException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.validate_full_topic_name import validate_full_topic_name

from grader.graph.discovery import published, settle
from grader.graph.graph_info import types_of
from grader.ros import message_values
from grader.ros.failure import Ros2Error, did_you_mean

if TYPE_CHECKING:
    import argparse

    from rclpy.node import Node

_POLL_S = 0.02


def expanded(node: Node, name: str) -> str:
    """Return the full name of a topic, such as "/turtle1/pose" for "turtle1/pose".

    Raises:
        Ros2Error: no topic can have this name.
    """
    try:
        full: str = expand_topic_name(name, node.get_name(), node.get_namespace())
        validate_full_topic_name(full)
    except (ValueError, InvalidTopicNameException) as error:
        raise Ros2Error(str(error)) from error
    return full


def find(node: Node, topic: str, args: argparse.Namespace) -> None:
    """Wait until the node has discovered a publisher of the topic, or until discovery has ended."""
    settle(node, lambda: published(node, topic), getattr(args, "spin_time", None))


def type_of(node: Node, topic: str, requested: str) -> Any | None:  # noqa: ANN401
    """Return the class of a topic's messages, or None if the topic does not exist. `requested` is the name as typed.

    Raises:
        Ros2Error: nodes use different types for the topic, or the type is not installed.
    """
    types = types_of(tuple(node.get_topic_names_and_types()), topic)
    if not types:
        return None
    if len(types) > 1:
        message = f"Cannot echo topic '{requested}', as it contains more than one type: [{', '.join(types)}]"
        raise Ros2Error(message)
    return message_values.load_type(types[0], "msg", text=f"The message type '{types[0]}' is invalid")


def not_published(requested: str) -> None:
    """Print a warning that the topic seems to have no publishers."""
    print(f"WARNING: topic [{requested}] does not appear to be published yet", flush=True)


def nearest_topic(node: Node, topic: str, text: str = "") -> str:
    """Return `text`, with another line if a topic has a similar name or if no node was found."""
    known = [name for name, _ in node.get_topic_names_and_types() if name != topic]
    return did_you_mean(topic, known, text, node.get_node_names())


def wait_for_type(node: Node, topic: str, requested: str) -> Any:  # noqa: ANN401
    """Wait until the topic has a publisher or a subscription, and return the class of its messages.

    Raises:
        Ros2Error: nodes use different types for the topic, or the type is not installed.
    """
    import sys

    made = type_of(node, topic, requested)
    if made is None:
        not_published(requested)
        hint = nearest_topic(node, topic)
        if hint:
            print(hint, file=sys.stderr, flush=True)
    while made is None:
        time.sleep(_POLL_S)
        made = type_of(node, topic, requested)
    return made
