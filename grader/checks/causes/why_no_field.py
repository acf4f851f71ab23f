"""Explain why a part of a service or an action, such as its Request, or an action client lacks an attribute."""

from __future__ import annotations

import re

from grader.checks.cause import Cause
from grader.common.words import shorten

PART = re.compile(r"(?P<of>\w+)_(?P<part>Request|Response|Goal|Result|Feedback)")
OF_HANDLES = ("cancel_goal", "get_result")
"""The beginnings of the names of methods that a goal handle has, and an action client lacks."""


def why_no_field(owner: str, name: str) -> Cause | None:
    """Return the cause if `owner` is such a part, or an ActionClient that lacks a method of goal handles, else None."""
    if owner == "ActionClient" and name.startswith(OF_HANDLES):
        return Cause("attribute-missing", f"{name} is a method of the goal handle, not of the client.")
    part = PART.fullmatch(owner)
    if part is None:
        return None
    text = (
        f"The {part['part'].lower()} of {part['of']} has no field {shorten(name)}. The command ros2 interface show "
        "prints the fields."
    )
    return Cause("message-field", text)
