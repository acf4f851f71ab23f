"""What happens to the goals of an action: the action rotate_absolute reports it to whoever runs the simulator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

TYPE = "turtlesim/action/RotateAbsolute"
What = Literal["accepted", "cancel requested", "result requested", "succeeded", "canceled", "aborted"]


@dataclass(frozen=True)
class GoalEvent:
    """What happened to the goal with this id of an action. turtlesim accepts every goal.

    `content` is the Goal when it is accepted, the Result when it has ended, and otherwise None.
    """

    action: str
    type: str
    goal_id: bytes
    what: What
    content: Any = None
