"""What a recording shows of the submission: its nodes, its publishers, its commands while the scenario ran."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.trial.recording import Command, Endpoint, Recording

ROS_TOPICS = ("/rosout", "/parameter_events", "/clock")
"""Every node publishes on these, or the grader does."""
START_S = 0.2
"""How long the first moment lasts: a trial's clock may start when the node is known, and its publisher not yet."""


def end_s(recording: Recording) -> float:
    """When the scenario was over, on the trial's clock (s): SIGINT, or when it would have come."""
    if recording.end.by == "itself":
        return max(recording.sigint_t_s, recording.duration_s)
    return recording.sigint_t_s


def ended_at_start(recording: Recording) -> bool:
    """Whether the node ended by itself before it waited for anything.

    Simulated time stands until the node waits; the wall's clock starts when the node is in the graph or drives, so one
    that is about to end may live on for the first moment.
    """
    end = recording.end
    return end.by == "itself" and end.t_s <= (START_S if recording.clock == "wall" else 0.0)


def commands(recording: Recording) -> tuple[Command, ...]:
    """The commands that arrived before SIGINT, by arrival.

    None, if none came after the first moment: what a node sends before the two sides have found each other is lost as
    a rule, and heard where the machine happens to delay the node. That must not decide about a report.
    """
    until = end_s(recording)
    found = tuple(command for command in recording.commands if command.t_s < until)
    return found if any(command.t_s > START_S for command in found) else ()


def nodes(recording: Recording) -> tuple[str, ...]:
    """Full names of the submission's nodes, in order of the alphabet; a name taken twice is there once."""
    own = Counter(recording.own_nodes)
    return tuple(sorted({name for graph in recording.graphs for name in Counter(graph.nodes) - own}))


def endpoints(recording: Recording, kind: str) -> tuple[Endpoint, ...]:
    """The submission's publishers or subscriptions, without those that every node has, each once."""
    found = {
        endpoint: None
        for graph in recording.graphs
        for endpoint in graph.endpoints
        if endpoint.kind == kind and endpoint.node not in recording.own_nodes and endpoint.topic not in ROS_TOPICS
    }
    return tuple(sorted(found, key=lambda endpoint: (endpoint.topic, endpoint.type, endpoint.node)))
