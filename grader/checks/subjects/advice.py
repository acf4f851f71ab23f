"""Advice: what would make the code better. It costs no points."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.kind import Kind, NoParams
from grader.checks.outcome import Finding, Status, failed, passed

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


def uses_timer(evidence: Evidence, _: NoParams) -> Finding:
    """The submission calls create_timer somewhere."""
    timers = evidence.code.calls("create_timer")
    if timers:
        return passed("The node uses a timer.")
    if evidence.code.node_file is None:
        return Finding(Status.SKIPPED, "Not judged, because the file of the node is not known yet.")
    if evidence.code.node_file not in {module.file for module in evidence.code.modules if module.tree is not None}:
        return Finding(Status.SKIPPED, "Not judged, because the file of the node cannot be read.")
    cause = "A node that runs its own loop receives no messages. With a timer, rclpy.spin does the waiting."
    if evidence.code.calls("create_rate"):
        cause = "A rate from create_rate only works while another thread spins the node. A timer needs no thread."
    return failed(
        "The node does not use a timer.",
        "A ROS 2 node does regular work in a timer callback.",
        Cause("no-timer", cause, evidence.place("publish", "sleep")),
    )


USES_TIMER = Kind(
    "uses_timer",
    "source",
    "The node uses a timer",
    NoParams,
    uses_timer,
    advice=True,
    about="Advises the student to use `create_timer` if the submission never calls it.",
)
