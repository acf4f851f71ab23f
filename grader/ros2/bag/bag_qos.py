"""The QoS of recorded topics: conversion to the format of rosbags, and profiles for recording and playing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.qos import QoSDurabilityPolicy, QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rclpy.duration import Duration


DEPTH = 1000
"""The depth of the queues. The depth is larger than in rosbag2 (10), because Python is slower than C++."""


def offered(publishers: Sequence[Any]) -> list[Qos]:
    """Return the QoS profiles that the publishers (TopicEndpointInfo of rclpy) of a topic offer."""
    return list(dict.fromkeys(_stored(publisher.qos_profile) for publisher in publishers))


def adapted(publishers: Sequence[Any]) -> QoSProfile:
    """Return a profile with the strictest reliability and durability that are compatible with every publisher."""
    profiles = [publisher.qos_profile for publisher in publishers]
    return _common(
        [profile.reliability == QoSReliabilityPolicy.RELIABLE for profile in profiles],
        [profile.durability == QoSDurabilityPolicy.TRANSIENT_LOCAL for profile in profiles],
    )


def to_play(recorded: Sequence[Qos]) -> QoSProfile:
    """Return a profile for the subscriptions that were compatible with all recorded publishers.

    Its reliability and durability are compatible with each of these subscriptions.
    """
    return _common(
        [profile.reliability is QosReliability.RELIABLE for profile in recorded],
        [profile.durability is QosDurability.TRANSIENT_LOCAL for profile in recorded],
    )


def _common(reliable: list[bool], kept: list[bool]) -> QoSProfile:
    return QoSProfile(
        history=QoSHistoryPolicy.KEEP_LAST,
        depth=DEPTH,
        reliability=QoSReliabilityPolicy.RELIABLE if all(reliable) else QoSReliabilityPolicy.BEST_EFFORT,
        durability=QoSDurabilityPolicy.TRANSIENT_LOCAL if kept and all(kept) else QoSDurabilityPolicy.VOLATILE,
    )


def _stored(profile: QoSProfile) -> Qos:
    return Qos(
        # DDS does not announce the history setting of other processes.
        history=QosHistory.UNKNOWN,
        depth=0,
        reliability=QosReliability[profile.reliability.name],
        durability=QosDurability[profile.durability.name],
        deadline=_time(profile.deadline),
        lifespan=_time(profile.lifespan),
        liveliness=QosLiveliness[profile.liveliness.name],
        liveliness_lease_duration=_time(profile.liveliness_lease_duration),
        avoid_ros_namespace_conventions=False,
    )


def _time(duration: Duration) -> QosTime:
    return QosTime(*divmod(duration.nanoseconds, 10**9))
