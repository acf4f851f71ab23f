"""Explain why a part of a service or an action, such as its Request, or an action client lacks an attribute."""

from __future__ import annotations

import re

from grader.checks.cause import Cause
from grader.common.words import shorten

PART = re.compile(r"(?P<of>\w+)_(?P<part>Request|Response|Goal|Result|Feedback)")
OF_HANDLES = ("cancel_goal", "get_result")
"""The beginnings of the names of methods that a goal handle has, and an action client lacks."""


def why_no_field(owner: str, name: str) -> Cause | None:
    """Return the cause if `owner` is such a part, an action client or a goal handle, else None."""
    if owner == "ActionClient" and name.startswith(OF_HANDLES):
        return Cause("attribute-missing", f"{name} is a method of the goal handle, not of the client.")
    if (owner, name) == ("ClientGoalHandle", "add_done_callback"):
        text = "add_done_callback is a method of a future, such as the one that get_result_async of the handle returns."
        return Cause("attribute-missing", text)
    part = PART.fullmatch(owner)
    if part is None:
        return None
    text = (
        f"The {part['part'].lower()} of {part['of']} has no field {shorten(name)}. The command ros2 interface show "
        "prints the fields."
    )
    return Cause("message-field", text)
