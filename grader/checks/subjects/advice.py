"""Advice: suggestions for better code. A student who does not follow them loses no points."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_ended import loops
from grader.checks.kind import Kind, NoParams
from grader.checks.outcome import Finding, Status, failed, passed
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


EXPECTED = "A ROS 2 node does periodic work in the callback of a timer."
ALWAYS = ("True", "1", "rclpy.ok()")
SENDS = frozenset({"publish", "info"})
WAITS = frozenset({"sleep"})


def uses_timer(evidence: Evidence, _: NoParams) -> Finding:
    """The submission calls create_timer, and has no endless loop that sleeps and also publishes or logs."""
    loop = _sending_loop(evidence)
    if evidence.code.calls("create_timer") and loop is None:
        return passed("The node uses a timer.")
    if evidence.code.node_file is None:
        return Finding(Status.SKIPPED, "Not judged, because the file of the node is unknown.")
    if evidence.code.node_file not in {module.file for module in evidence.code.modules if module.body}:
        return Finding(Status.SKIPPED, "Not judged, because the file of the node cannot be read, or contains no code.")
    cause = "A timer calls a method periodically, with a period that the node chooses."
    if loops(evidence) and not evidence.code.calls("spin_once"):
        cause = "While a node with one thread loops, it receives no messages. With a timer, rclpy.spin waits instead."
    if evidence.code.calls("create_rate"):
        cause = (
            "A rate from create_rate works only while another thread spins the node. A timer does not need an "
            "additional thread."
        )
    if evidence.code.calls("create_timer"):
        observed = "The node has a timer, but it publishes or logs in a loop that sleeps."
        return failed(observed, EXPECTED, Cause("no-timer", cause, loop))
    return failed(
        "The node does not use a timer.",
        EXPECTED,
        Cause("no-timer", cause, evidence.place("sleep", "publish")),
    )


def _sending_loop(evidence: Evidence) -> Where | None:
    """Return the place of a loop such as `while True` that calls `publish` or `info`, and also `sleep`, or None."""
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.While) and ast.unparse(node.test) in ALWAYS:
                calls = {
                    getattr(each.func, "attr", getattr(each.func, "id", ""))
                    for each in ast.walk(node)
                    if isinstance(each, ast.Call)
                }
                if calls & SENDS and calls & WAITS:
                    return Where(module.file, node.lineno)
    return None


USES_TIMER = Kind(
    "uses_timer",
    "source",
    "The node uses a timer",
    NoParams,
    uses_timer,
    advice=True,
    about="Advises the student to use a timer if the submission never calls `create_timer`, or publishes or logs in "
    "an endless loop that sleeps.",
)
