"""Pauses: how long a node has nothing to do, so that its clock need not advance frame by frame.

A node in simulated time wakes up for each message on /clock, although its timers are due only in a few frames. The
launcher knows when the next timer is due (launcher.publish_pauses). A trial leaves out the messages before that.
"""

from __future__ import annotations

import os
import struct
from collections import Counter
from typing import TYPE_CHECKING

from grader.trial.launcher import PAUSES
from grader.turtlesim.turtle import FRAME_S

if TYPE_CHECKING:
    from grader.trial.simulation import Simulation

_PAUSE = struct.Struct("=qq")
_EARLIER_S = 1e-6
"""A pause ends this much (s) before the timer is due, since the times are not exact."""
_AGAIN_S = 0.5
"""If the simulator might interrupt a pause, no pause is looked for during this time (s), since this is slow."""


class Pauses:
    """Finds the pauses of the nodes in a simulation."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._from_s = 0.0

    def pause_s(self) -> float:
        """Return how long no node will do anything (s). Call this when all nodes are at rest. If unknown, return 0."""
        now_s = self._simulation.now()
        if now_s < self._from_s:
            return 0.0
        shortest_s = min(process_pause_s(node.pid, node.pause_address) for node in self._simulation.node.processes)
        if shortest_s <= FRAME_S:
            return 0.0
        if may_interrupt(self._simulation):
            self._from_s = now_s + _AGAIN_S
            return 0.0
        return shortest_s - _EARLIER_S


def process_pause_s(pid: int, address: int) -> float:
    """Return how long the sleeping process has nothing to do unless it receives something (s). If unknown, return 0.

    The launcher of the node keeps this number at `address` in the memory of the process. A node that changes the number
    only harms itself, since the time on its clock is then wrong.
    """
    try:
        memory = os.open(f"/proc/{pid}/mem", os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return 0.0
    try:
        magic, pause_ns = _PAUSE.unpack(os.pread(memory, _PAUSE.size, address))
    except (OSError, struct.error):  # another program runs in the process now, so the address is not mapped
        return 0.0
    finally:
        os.close(memory)
    return max(0.0, pause_ns / 1e9) if magic == PAUSES else 0.0


def may_interrupt(simulation: Simulation) -> bool:
    """Return whether the simulator might send a node something in the middle of a pause.

    That is the case if a node receives messages from the simulator or has a client for it, or if the trial makes calls.
    """
    if simulation.inputs.calls or simulation.may_act():
        return True
    nodes = simulation.nodes
    own = Counter(subscription.topic_name for node in nodes for subscription in node.subscriptions)
    for publisher in (each for node in nodes for each in node.publishers):
        topic = publisher.topic_name
        if topic != "/clock" and publisher.get_subscription_count() > own[topic]:
            return True
    # This does not use Node.count_clients, which validates the name each time and takes four times as long.
    return any(node.handle.get_count_clients(service.service_name) for node in nodes for service in node.services)
