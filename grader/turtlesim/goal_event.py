"""The events that the action rotate_absolute reports to the owner of the simulator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

TYPE = "turtlesim/action/RotateAbsolute"
What = Literal["accepted", "cancel requested", "result requested", "succeeded", "canceled", "aborted"]


@dataclass(frozen=True)
class GoalEvent:
    """An event of the goal `goal_id`. There is no event for a rejected goal, because turtlesim accepts every goal.

    `content` is the Goal if the goal was accepted, the Result if the goal has ended, and None otherwise.
    """

    action: str
    type: str
    goal_id: bytes
    what: What
    content: Any = None
