"""Made-up trials of a node that publishes on some topics and subscribes to others, and the findings about them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from grader.checks.subjects.topic import PUBLISHES
from grader.tests.checks.made import NODE_FILE, TOPIC, TWIST, evidence, found, node, recording
from grader.trial.recording import Endpoint, Graph, Recording

if TYPE_CHECKING:
    from grader.checks.outcome import Finding

TEXT = "std_msgs/msg/String"
COLOR = "turtlesim/msg/Color"
POSE = "/turtle1/pose"


def observed(*ends: tuple[Literal["publisher", "subscription"], str, str], **changes: Any) -> Recording:  # noqa: ANN401
    """Return a trial in which the node had these publishers and subscriptions (kind, topic, type)."""
    endpoints = tuple(Endpoint(kind, "/draw_circle", topic, type_) for kind, topic, type_ in ends)
    ours = Endpoint("subscription", "/turtlesim", TOPIC, TWIST)
    graph = Graph(0.0, ("/turtlesim", "/draw_circle"), (ours, *endpoints))
    return recording([], graphs=(graph,), **changes)


def publishes(trial: Recording, *changes: tuple[str, str], topic: str = TOPIC, type_: str = TWIST) -> Finding:
    return found(PUBLISHES, evidence(trial, node(*changes)), topic=topic, type=type_)


def reported(finding: Finding) -> tuple[str | None, str | None]:
    return finding.diagnosis, None if finding.where is None else str(finding.where).removeprefix(NODE_FILE)
