"""The service calls and goals of a trial, as rows of a table and as moments of a replay."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.common.words import shorten

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.trial.observed import Call, Goal
    from grader.trial.recording import Recording

MOST_ROWS = 100
"""The maximum number of calls in a table or replay, and also the maximum number of goals."""
MOST_TEXT = 120
"""The maximum length of a request, a response, a goal or a result (characters)."""


def call_rows(recording: Recording) -> list[tuple[str, ...]]:
    """Return the first service calls as strings: the time, the caller, the service, the request and the response."""
    return [
        (f"{call.t_s:.2f}", _caller(call), call.service, _fields(call.request), _fields(call.response))
        for call in recording.calls[:MOST_ROWS]
    ]


def goal_rows(recording: Recording) -> list[tuple[str, ...]]:
    """Return the first goals as strings: start time, goal, status, end time, result and action."""
    return [
        (
            f"{goal.t_s:.2f}",
            _fields(goal.request),
            goal.status,
            "" if goal.ended_s is None else f"{goal.ended_s:.2f}",
            _fields(goal.result),
            goal.action,
        )
        for goal in recording.goals[:MOST_ROWS]
    ]


def moments(recording: Recording) -> list[tuple[float, str]]:
    """Return the events of a replay as (time in s, text), sorted by time.

    The events are the first calls, and the start, the cancel request and the end of the first goals.
    """
    found = [(call.t_s, f"{_caller(call)} calls {shorten(call.service)}") for call in recording.calls[:MOST_ROWS]]
    for goal in recording.goals[:MOST_ROWS]:
        found += _moments_of(goal)
    return sorted(found, key=lambda moment: moment[0])


def _moments_of(goal: Goal) -> list[tuple[float, str]]:
    name, reached = shorten(goal.action), goal.status == "succeeded"
    times = (
        (goal.t_s, f"the node sends a goal to {name}: {_fields(goal.request)}"),
        (goal.cancel_asked_s, f"the node asks {name} to cancel the goal"),
        (goal.ended_s, "the goal is reached" if reached else f"the goal sent to {name} is {goal.status}"),
    )
    return [(t_s, text) for t_s, text in times if t_s is not None]


def _caller(call: Call) -> str:
    return "the trial" if call.by_trial else "the node"


def _fields(values: Mapping[str, object] | None) -> str:
    if values is None:
        return "none"
    rounded = {name: round(value, 3) if isinstance(value, float) else value for name, value in values.items()}
    return shorten(", ".join(f"{name}={value}" for name, value in rounded.items()), MOST_TEXT)
