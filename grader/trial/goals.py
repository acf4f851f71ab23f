"""The goals that nodes send to the actions of the simulator, and their results."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from grader.ros.message_values import plain
from grader.trial.observed import MOST_GOALS, Goal

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.turtlesim.goal_event import GoalEvent


class GoalLog:
    """Records the events of the first MOST_GOALS goals."""

    def __init__(self, now: Callable[[], float]) -> None:
        """Create an empty log. `now` returns the current time on the trial's clock (s)."""
        self._now = now
        self._goals: dict[bytes, Goal] = {}

    @property
    def goals(self) -> tuple[Goal, ...]:
        """The recorded goals, in the order in which they were accepted."""
        return tuple(self._goals.values())

    def add(self, event: GoalEvent) -> None:
        """Record an event of a goal."""
        now_s, goal = self._now(), self._goals.get(event.goal_id)
        if event.what == "accepted" and len(self._goals) < MOST_GOALS:
            self._goals[event.goal_id] = Goal(now_s, event.action, event.type, plain(event.content))
        elif goal is None or event.what == "accepted":
            return
        elif event.what == "result requested":
            self._goals[event.goal_id] = replace(
                goal, result_asked_s=now_s if goal.result_asked_s is None else goal.result_asked_s
            )
        elif event.what == "cancel requested":
            self._goals[event.goal_id] = replace(goal, cancel_asked_s=now_s)
        else:
            self._goals[event.goal_id] = replace(goal, status=event.what, result=plain(event.content), ended_s=now_s)
