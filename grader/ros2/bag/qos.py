"""QoS of recorded topics: what publishers offered, as rosbags stores it, and what fits when it is read or played."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.qos import QoSDurabilityPolicy, QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rclpy.duration import Duration


DEPTH = 1000
"""Messages that wait until this process takes them. Python is slower than C++: rosbag2 waits with 10."""


def offered(publishers: Sequence[Any]) -> list[Qos]:
    """What the publishers of a topic offer; `publishers` are rclpy's TopicEndpointInfo."""
    return list(dict.fromkeys(_stored(publisher.qos_profile) for publisher in publishers))


def adapted(publishers: Sequence[Any]) -> QoSProfile:
    """A profile that hears every publisher: as strict as the least strict of them."""
    profiles = [publisher.qos_profile for publisher in publishers]
    return _common(
        [profile.reliability == QoSReliabilityPolicy.RELIABLE for profile in profiles],
        [profile.durability == QoSDurabilityPolicy.TRANSIENT_LOCAL for profile in profiles],
    )


def to_play(recorded: Sequence[Qos]) -> QoSProfile:
    """A profile that every subscription hears that heard the recorded publishers."""
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
        # The history of another process is not known (DDS does not announce it).
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
