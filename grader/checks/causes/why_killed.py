"""Explain why a target was removed although nobody caught it: the node calls /kill or /reset on its own."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.words import shorten
from grader.submission.constants import evaluate

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Call
    from grader.submission.where import Where
    from grader.trial.observed import Track

KILL, RESET = "/kill", "/reset"
SAME_TIME_S = 0.1
"""The maximum difference between the recorded times of two simultaneous events (s)."""
LONGEST_S = 1.0
"""The maximum time (s) from a call to the removal that it causes."""


def why_killed(evidence: Evidence, track: Track, service: str) -> Cause:
    """Return the cause for a target that was removed before `service`, which catches targets, was called for it."""
    name = shorten(track.turtle)
    same = _same_name(evidence)
    if same is not None:
        return same
    text = f"Remove a target only in the callback of {service}."
    gone_s = track.gone_s or 0.0
    for call in evidence.recording.calls:
        if call.by_trial or not -SAME_TIME_S <= gone_s - call.t_s <= LONGEST_S:
            continue
        if call.service == KILL and call.request.get("name") == track.turtle:
            text = (
                f"{KILL} was called for {name}, but {service} was not called before. Call {KILL} only in the callback "
                f"of {service}, with the name in its request."
            )
        elif call.service == RESET:
            text = f"{RESET} was called, which removes all turtles except turtle1."
    return Cause("killed-uncaught", text, _place(evidence))


def _place(evidence: Evidence) -> Where | None:
    """Return the place where the node creates a request to /kill, or else uses a client, or else its file, or None."""
    return kill_request(evidence) or evidence.place("call_async", "create_client")


def kill_request(evidence: Evidence) -> Where | None:
    """Return the place where the code creates a request to /kill, or None."""
    for call in evidence.code.calls("Request"):
        if isinstance(call.node.func, ast.Attribute) and ast.unparse(call.node.func.value) == "Kill":
            return call.where
    return None


def _same_name(evidence: Evidence) -> Cause | None:
    """Return the cause if this node and the node beside it have the same name in their own files, else None."""
    others = [spec for spec in evidence.exercise.trials if spec.id == evidence.trial.beside]
    for other in others:
        beside = evidence.from_trial(other.id)
        theirs = {_name(call) for call in _own_calls(beside)} - {None}
        for call in _own_calls(evidence):
            if beside.node_file != evidence.node_file and _name(call) in theirs:
                text = f"Both nodes have the name {_name(call)}, so it is unknown which node calls a service."
                return Cause("node-name", text, call.where)
    return None


def _own_calls(evidence: Evidence) -> list[Call]:
    """Return the calls to __init__ in the node's own file. The files that it imports may contain other nodes."""
    return [call for call in evidence.code.calls("__init__") if call.module.file == evidence.node_file]


def _name(call: Call) -> str | None:
    value = evaluate(call.argument(0, "node_name"), call.module.names)
    return shorten(value) if isinstance(value, str) else None
