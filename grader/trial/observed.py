"""What a recording holds besides messages: service calls, pens, and the other turtles."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping


@dataclass(frozen=True)
class Call:
    """A call of a service, with its request and response as plain data, at the time `t_s` of the trial's clock.

    If `by_trial` is False, a node called the simulator. Otherwise, the trial called the node. Then `response` is None
    and `answered_s` is None as long as there is no response, and `missing` says that no node offered the service.
    """

    t_s: float
    service: str
    type: str
    request: Mapping[str, Any]
    response: Mapping[str, Any] | None = None
    answered_s: float | None = None
    by_trial: bool = False
    missing: bool = False

    def answered(self, t_s: float, response: Mapping[str, Any]) -> Call:
        """Return the call with its response, which arrived at this time (s)."""
        return replace(self, response=response, answered_s=t_s)


@dataclass(frozen=True)
class Offer:
    """A service that a node of the submission offers, without the services that every node has."""

    node: str
    service: str
    type: str


@dataclass(frozen=True)
class PenChange:
    """The pen of a turtle from the time `t_s` on: its colour (red, green, blue), its width (px), whether it draws."""

    t_s: float
    turtle: str
    color: tuple[int, int, int]
    width: int
    down: bool


@dataclass(frozen=True)
class Track:
    """Where a turtle other than turtle1 was: rows of t_s (s), x and y (m) and theta (rad), one per change.

    The first row is its first frame. `gone_s` is when it was killed (s), or None.
    """

    turtle: str
    rows: tuple[tuple[float, float, float, float], ...]
    gone_s: float | None = None
