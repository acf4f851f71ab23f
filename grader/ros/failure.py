"""The error of a `ros2` verb: a message on standard error and exit code 1, as in the real command."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from grader.common.words import nearest, printable
from grader.errors import GraderError

if TYPE_CHECKING:
    from collections.abc import Iterable


OTHER = "/other"
"""The default of `nodes` in `did_you_mean`: the name of a visible node, so that `did_you_mean` assumes that a node is
running."""


class Ros2Error(GraderError):
    """A verb failed. Only the message of this error is printed, and nothing is printed if the message is empty."""

    exit_code = 1


def did_you_mean(name: str, candidates: Iterable[str], text: str = "", nodes: Iterable[str] = (OTHER,)) -> str:
    """Return `text`, followed by a line that suggests the most similar candidate if one is similar enough.

    `nodes` contains the names of the discovered nodes. If all of them are hidden, like the node of this command, the
    line says instead that no node was found. Probably, the user has not started a node, or it runs in another domain.
    """
    found = similar(name, candidates)
    hint = f"Did you mean '{printable(found)}'?" if found else ""
    if all(node.rpartition("/")[2].startswith("_") for node in nodes):
        domain = os.environ.get("ROS_DOMAIN_ID") or "0"
        from grader.ros.stopped import stopped_sentence

        start = stopped_sentence() or "Start one in another terminal, for example: grader sim"
        hint = f"No node was found in ROS domain {domain}. {start}"
    return "\n".join(part for part in (text, hint) if part)


def similar(name: str, candidates: Iterable[str]) -> str | None:
    """Return the candidate that is most similar to `name` but not equal to it, or None if none is similar enough."""
    others = [candidate for candidate in candidates if candidate != name]
    found = others[0] if len(others) == 1 and others[0].endswith(f"/{name}") else nearest(name, others)
    if not found and len(name) > 2:
        found = next((other for other in sorted(others) if other.startswith(name)), None)
    return found
