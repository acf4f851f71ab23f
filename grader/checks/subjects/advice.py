"""Advice: what would be better, and costs nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.kind import Kind, NoParams
from grader.checks.outcome import Finding, Status, failed, passed

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


def uses_timer(evidence: Evidence, _: NoParams) -> Finding:
    """The submission calls create_timer somewhere."""
    timers = evidence.code.calls("create_timer")
    if timers:
        return passed("A timer gives the rhythm.")
    if evidence.code.node_file is None:
        return Finding(Status.SKIPPED, "Not judged, since it is not known yet which file is the node's.")
    if evidence.code.node_file not in {module.file for module in evidence.code.modules if module.tree is not None}:
        return Finding(Status.SKIPPED, "Not judged, since the node's file cannot be read.")
    cause = "In a loop of its own a node hears nothing from other nodes; a timer leaves the waiting to rclpy.spin."
    if evidence.code.calls("create_rate"):
        cause = "What create_rate gives only wakes up while another thread spins the node; a timer needs no thread."
    return failed(
        "no-timer",
        "No timer is used.",
        "ROS 2 nodes do regular work in a timer.",
        cause,
        where=evidence.place("publish", "sleep"),
    )


USES_TIMER = Kind(
    "uses_timer",
    "source",
    "A timer gives the rhythm",
    NoParams,
    uses_timer,
    advice=True,
    about="Advises the student to use `create_timer` if the submission calls it nowhere.",
)
