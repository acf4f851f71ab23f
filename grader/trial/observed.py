"""Parts of a recording: service calls, offered services, action goals, pens, and the tracks of other turtles."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from collections.abc import Mapping


MOST_GOALS = 1000
"""The maximum number of goals in a recording. A node that keeps sending goals must not fill the grader's memory."""


@dataclass(frozen=True)
class Call:
    """A service call, with its request and response as plain data, at the time `t_s` of the trial's clock.

    If `by_trial` is False, a node called one of the grader's nodes or another node of the submission. In a call between
    nodes of the submission, `response` and `answered_s` are always None. If `by_trial` is True, the trial called the
    node. In a call by the trial, `response` and `answered_s` are None until the response arrives, and `missing` is True
    if no node offered the service.
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
    """A service that a node of the submission offers. The services that every node offers are left out."""

    node: str
    service: str
    type: str


@dataclass(frozen=True)
class Goal:
    """A goal that a node sent to an action of the simulator.

    `t_s` is the time at which the simulator accepted the goal.

    Each of the other times (s) is None if the event did not happen. The events are: a client requested the result
    (`result_asked_s`), a client requested cancellation (`cancel_asked_s`), and the goal ended with this `status`
    (`ended_s`).
    """

    t_s: float
    action: str
    type: str
    request: Mapping[str, Any]
    status: Literal["executing", "succeeded", "canceled", "aborted"] = "executing"
    result: Mapping[str, Any] | None = None
    ended_s: float | None = None
    result_asked_s: float | None = None
    cancel_asked_s: float | None = None


@dataclass(frozen=True)
class PenChange:
    """A turtle's pen from the time `t_s` on: its colour (red, green, blue), its width (px), and whether it is down."""

    t_s: float
    turtle: str
    color: tuple[int, int, int]
    width: int
    down: bool


@dataclass(frozen=True)
class Track:
    """The track of a turtle other than turtle1: rows of t_s (s), x and y (m) and theta (rad), one row per change.

    The first row is from the turtle's first frame. `gone_s` is the time at which the turtle was removed (s), or None.
    """

    turtle: str
    rows: tuple[tuple[float, float, float, float], ...]
    gone_s: float | None = None
