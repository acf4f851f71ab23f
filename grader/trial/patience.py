"""How long simulated time waits for a node: by what the node works, so that a loaded machine changes nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.trial.rest import Threads

ASLEEP_S = 20.0
"""How long a node may sleep until it waits for its clock."""
WORKED_S = 20.0
"""How long it may work until then (CPU time)."""
HANDSHAKE_S = 100.0
"""How long the two together may take on the most crowded machine: the trial as a whole ends soon after (trial.py)."""
TICK_CPU_S = 1.0
"""A node that works longer than this on one frame never rests."""
TICK_S = 30.0
ASK_EVERY_S = 0.02
"""How often its CPU time is asked for."""


class HandshakePatience:
    """How long a node may take until it waits for its clock: as long as it works, or waits for us, it goes on."""

    def __init__(self, now_s: float) -> None:
        self._begun_s = self._seen_s = now_s
        self._asleep_s = 0.0

    def ended(self, now_s: float, *, asleep: bool, wrote: bool, worked_s: float) -> bool:
        """Whether it has taken too long.

        Args:
            now_s: the monotonic clock.
            asleep: all of its threads sleep. One that only waits for a processor does not.
            wrote: there was output to read. Who writes much sleeps until we have read.
            worked_s: its CPU time so far.
        """
        if asleep and not wrote:
            self._asleep_s += now_s - self._seen_s
        self._seen_s = now_s
        return self._asleep_s > ASLEEP_S or worked_s > WORKED_S or now_s - self._begun_s > HANDSHAKE_S


class TickPatience:
    """How long node and simulator may answer each other at one instant.

    Most instants are over long before it first asks for the node's CPU time, which costs as much as a look.
    """

    def __init__(self, node: Threads, now_s: float) -> None:
        self._node = node
        self._cpu_s: float | None = None
        self._deadline_s = now_s + TICK_S
        self._ask_s = now_s + ASK_EVERY_S

    def ended(self, now_s: float) -> bool:
        """Whether the node has worked too long; counts from the first time that its CPU time is asked for."""
        if now_s < self._ask_s:
            return False
        self._ask_s = now_s + ASK_EVERY_S
        if self._cpu_s is None:
            self._cpu_s = self._node.run_time_s()
        return now_s > self._deadline_s or self._node.run_time_s() - self._cpu_s > TICK_CPU_S
