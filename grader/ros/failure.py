"""The error of a `ros2` verb: a message on standard error and exit code 1, as in the real command."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.common.words import nearest, printable
from grader.errors import GraderError

if TYPE_CHECKING:
    from collections.abc import Iterable


class Ros2Error(GraderError):
    """A verb failed. Only the message of this error is printed, and nothing is printed if the message is empty."""

    exit_code = 1


def did_you_mean(name: str, candidates: Iterable[str], text: str = "") -> str:
    """Return `text`, followed by a line that suggests the most similar candidate if one is similar enough."""
    others = [candidate for candidate in candidates if candidate != name]
    found = others[0] if len(others) == 1 and others[0].endswith(f"/{name}") else nearest(name, others)
    if not found and len(name) > 2:
        found = next((other for other in sorted(others) if other.startswith(name)), None)
    return "\n".join(part for part in (text, f"Did you mean '{printable(found)}'?" if found else "") if part)
