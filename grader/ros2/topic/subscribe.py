"""Subscribe to a topic for `topic echo`, with a QoS that the options or the publishers determine."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.event_handler import SubscriptionEventCallbacks, UnsupportedEventTypeError
from rclpy.qos import QoSDurabilityPolicy, QoSReliabilityPolicy

from grader.ros2 import qos

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from rclpy.node import Node


def chosen_qos(node: Node, topic: str, args: argparse.Namespace) -> Any:  # noqa: ANN401
    """Return the QoS that the options specify.

    If the topic has publishers, and no QoS option other than --qos-profile is given, the reliability and the durability
    are the strictest that are compatible with every publisher.
    """
    profile = qos.profile(args)
    publishers = [info.qos_profile for info in node.get_publishers_info_by_topic(topic)]
    if qos.is_chosen(args) or not publishers:
        return profile
    for policy, strict, lax in (
        ("reliability", QoSReliabilityPolicy.RELIABLE, QoSReliabilityPolicy.BEST_EFFORT),
        ("durability", QoSDurabilityPolicy.TRANSIENT_LOCAL, QoSDurabilityPolicy.VOLATILE),
    ):
        offered = [getattr(publisher, policy) == strict for publisher in publishers]
        if any(offered) and not all(offered):
            kind = f"QoS{policy.capitalize()}Policy"
            print(
                f"Some, but not all, publishers are offering {kind}.{strict.name}. Falling back to "
                f"{kind}.{lax.name} as it will connect to all publishers",
                flush=True,
            )
        setattr(profile, policy, strict if all(offered) else lax)
    return profile


def subscribe(
    node: Node,
    kind: Any,  # noqa: ANN401
    topic: str,
    show: Callable[[Any, dict[str, Any]], None],
    profile: Any,  # noqa: ANN401
    args: argparse.Namespace,
) -> None:
    """Subscribe to a topic, and call `show` with each message and information about it.

    Report lost messages unless the options disable such reports.
    """
    lost = None if args.no_lost_messages else SubscriptionEventCallbacks(message_lost=_report_lost)
    try:
        node.create_subscription(kind, topic, show, profile, event_callbacks=lost, raw=args.raw)
    except UnsupportedEventTypeError:
        node.create_subscription(kind, topic, show, profile, raw=args.raw)


def _report_lost(status: Any) -> None:  # noqa: ANN401
    print(
        f"A message was lost!!!\n\ttotal count change:{status.total_count_change}\n"
        f"\ttotal count: {status.total_count}---",
        flush=True,
    )
