"""The QoS options of verbs that publish or subscribe, and the resulting profile."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    import argparse

PROFILES = (
    "unknown",
    "default",
    "system_default",
    "sensor_data",
    "services_default",
    "parameters",
    "parameter_events",
    "action_status_default",
    "best_available",
)
"""The names of rclpy's preset profiles. They are listed here, so that `--help` need not import rclpy. A test compares
them with rclpy's names."""
POLICIES = {
    "history": ("system_default", "keep_last", "keep_all", "unknown"),
    "reliability": ("system_default", "reliable", "best_effort", "unknown", "best_available"),
    "durability": ("system_default", "transient_local", "volatile", "unknown", "best_available"),
    "liveliness": ("system_default", "automatic", "manual_by_topic", "unknown", "best_available"),
}
"""Maps each policy to the names of its values in rclpy."""


def add_qos(parser: argparse.ArgumentParser, default: str) -> None:
    """Add the options. `default` is the default preset profile."""
    parser.add_argument(
        "--qos-profile",
        choices=PROFILES,
        default=default,
        help=f"preset profile; other options override its values (default: {default})",
    )
    parser.add_argument("--qos-depth", metavar="N", type=int, help="size of the queue (default: as in the profile)")
    for policy, choices in POLICIES.items():
        parser.add_argument(f"--qos-{policy}", choices=choices, help=f"{policy} policy (default: as in the profile)")
    parser.add_argument(
        "--qos-liveliness-lease-duration-seconds", type=float, help="liveliness lease duration in seconds"
    )


def is_chosen(args: argparse.Namespace) -> bool:
    """Return whether the user has set an option other than the preset profile."""
    names = ("depth", *POLICIES, "liveliness_lease_duration_seconds")
    return any(getattr(args, f"qos_{name}") is not None for name in names)


def profile(args: argparse.Namespace) -> Any:  # noqa: ANN401
    """Return the rclpy.qos.QoSProfile that the options specify.

    Raises:
        Ros2Error: the lease duration is too long.
    """
    from rclpy import qos
    from rclpy.duration import Duration

    made = qos.QoSPresetProfiles.get_from_short_key(args.qos_profile)
    for policy in POLICIES:
        wanted = getattr(args, f"qos_{policy}")
        if wanted:
            kind = getattr(qos, f"QoS{policy.capitalize()}Policy")
            setattr(made, policy, kind.get_from_short_key(wanted))
    lease_s = args.qos_liveliness_lease_duration_seconds
    if lease_s and lease_s >= 0:
        try:
            made.liveliness_lease_duration = Duration(seconds=lease_s)
        except OverflowError as error:
            message = f"The liveliness lease duration is too long: {lease_s:g} s"
            raise Ros2Error(message) from error
    if args.qos_depth and args.qos_depth >= 0:
        made.depth = args.qos_depth
    elif made.durability == qos.QoSDurabilityPolicy.TRANSIENT_LOCAL and made.depth == 0:
        made.depth = 1
    return made
