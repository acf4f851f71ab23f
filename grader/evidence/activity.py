"""The nodes, publishers and commands of the submission during the scenario, taken from a recording."""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.trial.recording import Command, Endpoint, Recording

ROS_TOPICS = ("/rosout", "/parameter_events", "/clock")
"""Topics on which every node publishes, or on which the grader publishes."""
OF_LIFECYCLE = "lifecycle_msgs/msg/TransitionEvent"
"""The type of the topic on which each lifecycle node publishes."""
SPINS = re.compile(r'executors\.py", line \d+, in (?:await_or_execute|handler|_execute_\w+)\b')
"""Matches a traceback entry for the code in rclpy's executor that calls callbacks."""
TRACEBACK = "Traceback (most recent call last)"
IN_CONSTRUCTOR = ", in __init__"
"""The end of a traceback entry for the code of a constructor."""
START_S = 0.2
"""The length of the initial period (s). In this period, the node's publisher may not have been discovered yet."""


def end_s(recording: Recording) -> float:
    """Return the end of the scenario on the trial's clock (s): the time of SIGINT, or the scheduled end if it is later.

    The scheduled end is used only if the node exited on its own.
    """
    if recording.end.by == "itself":
        return max(recording.sigint_t_s, recording.duration_s)
    return recording.sigint_t_s


def ended_at_start(recording: Recording) -> bool:
    """Return whether the node exited on its own before it ran, that is, before it could do anything.

    A node that raised an exception inside rclpy's spin did run, no matter how soon it exited. A node that raised an
    exception in a constructor and sent no command did not run, no matter how late it exited: on a busy machine, the
    start takes longer than the initial period (START_S). The same holds for a program that exited without an error
    before its node appeared in the graph. These rules depend neither on the clock nor on the time at which the grader
    first observed the node. If none of them applies, a node that exits in the initial period counts as a node that did
    not run.
    """
    end = recording.end
    if end.by != "itself" or spun(recording):
        return False
    if end.t_s <= START_S:
        return True
    return not recording.commands and (_failed_in_constructor(recording) or _left_without_a_node(recording))


def _left_without_a_node(recording: Recording) -> bool:
    """Return whether the program exited without an error before any of its nodes appeared in the graph."""
    return recording.end.exit_code == 0 and TRACEBACK not in recording.stderr.text and not nodes(recording)


def _failed_in_constructor(recording: Recording) -> bool:
    """Return whether the last traceback in standard error has an entry for the code of a constructor."""
    _, found, last = recording.stderr.text.rpartition(TRACEBACK)
    return bool(found) and IN_CONSTRUCTOR in last


def spun(recording: Recording) -> bool:
    """Return whether standard error shows an exception from a callback that was called by rclpy's executor."""
    return bool(SPINS.search(recording.stderr.text))


def commands(recording: Recording) -> tuple[Command, ...]:
    """Return the commands that arrived before the end of the scenario (`end_s`), in the order of arrival.

    If all commands arrived in the initial period (START_S), return an empty tuple. A command that is published before
    the end of discovery is usually lost. Whether it arrives depends on the machine, but a report must not depend on the
    machine.
    """
    until = end_s(recording)
    found = tuple(command for command in recording.commands if command.t_s < until)
    return found if any(command.t_s > START_S for command in found) else ()


def nodes(recording: Recording) -> tuple[str, ...]:
    """Return the full names of the submission's nodes, sorted and without duplicates."""
    own = Counter(recording.own_nodes)
    return tuple(sorted({name for graph in recording.graphs for name in Counter(graph.nodes) - own}))


def endpoints(recording: Recording, kind: str) -> tuple[Endpoint, ...]:
    """Return the publishers or subscriptions of the submission without duplicates, except on topics of ROS 2 itself."""
    found = {
        endpoint: None
        for graph in recording.graphs
        for endpoint in graph.endpoints
        if endpoint.kind == kind and endpoint.node not in recording.own_nodes
        if endpoint.topic not in ROS_TOPICS and endpoint.type != OF_LIFECYCLE
    }
    return tuple(sorted(found, key=lambda endpoint: (endpoint.topic, endpoint.type, endpoint.node)))
