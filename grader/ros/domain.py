"""The domain that the user has chosen with ROS_DOMAIN_ID."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

HIGHEST = 232
"""The highest domain id whose port numbers are valid (DDSI-RTPS, 9.6.1)."""


def wrong_domain(env: Mapping[str, str]) -> str:
    """Return an error message if ROS_DOMAIN_ID is not a valid domain id, or else an empty string."""
    text = env.get("ROS_DOMAIN_ID", "") or "0"
    if text.isascii() and text.isdecimal() and len(text) < 100 and int(text) <= HIGHEST:
        return ""
    return (
        f"ROS_DOMAIN_ID is '{text[:40]}'; a whole number from 0 to {HIGHEST} was expected. "
        "To use the usual domain, type: unset ROS_DOMAIN_ID"
    )
