"""Time limits for a node.

The limits apply to CPU time and to the time for which the node sleeps, so the load of the machine has hardly any
effect. Only HANDSHAKE_S and TICK_S apply to wall time. If a trial has several nodes, the limits apply to their total
CPU time, and to the time for which all of them sleep.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.trial.node_group import GroupThreads
    from grader.trial.rest import Threads

HANDSHAKE_LIMIT_S = 20.0
"""The maximum time (s) that a node may sleep, and the maximum CPU time (s) that it may use, before it waits for its
clock."""
HANDSHAKE_S = 100.0
"""The maximum wall time until a node waits for its clock (s). A node reaches this limit only on a crowded machine,
or if it keeps writing output while it sleeps. The limit for the whole trial is higher (trial.py)."""
TICK_CPU_S = 1.0
"""The maximum CPU time (s) that a node may use on one frame. If a node uses more, it is assumed never to become
idle."""
LATE_CPU_S = 0.3
"""If a node computes for longer than this (s) on one frame, it would be late in wall time. For comparison, the pauses
of the solutions are 0.5 s long, and they compute for a few milliseconds."""
TICK_S = 30.0
"""The maximum wall time for the node and the simulator to respond to each other in one frame (s)."""
SHARED = 0.1
"""If a second thread did at least this share of the work, several threads kept the node from becoming idle."""
REQUEST_EVERY_S = 0.02
"""The interval at which the CPU time of the node is checked (s)."""


class HandshakePatience:
    """The time limit for the start of a node: until it waits for its clock or, in wall time, until it is in the graph.

    `limit_s` is the maximum time that the node may sleep (s), and also the maximum CPU time that it may use (s). Time
    in which the node waits for the grader to read its output does not count as sleep.
    """

    def __init__(self, now_s: float, limit_s: float = HANDSHAKE_LIMIT_S) -> None:
        self._begun_s = self._cpu_observed_s = now_s
        self._limit_s = limit_s
        self._asleep_s = 0.0

    def ended(self, now_s: float, *, asleep: bool, wrote: bool, worked_s: float) -> bool:
        """Return whether the node has taken too long.

        `now_s` is the time of the monotonic clock (s). `asleep` is true if all threads are sleeping. A thread that is
        waiting for a processor is not sleeping. `wrote` is true if there was output to read: a node that writes a lot
        sleeps until the output is read. `worked_s` is the CPU time (s) that the node has used.
        """
        if asleep and not wrote:
            self._asleep_s += now_s - self._cpu_observed_s
        self._cpu_observed_s = now_s
        return max(self._asleep_s, worked_s) > self._limit_s or now_s - self._begun_s > HANDSHAKE_S


class TickPatience:
    """The time limit for the node and the simulator to respond to each other at one instant of simulated time.

    Reading the CPU time of the node takes as long as checking its threads. Therefore, the CPU time is not read at
    first, and in most cases it is never needed.
    """

    def __init__(self, node: Threads | GroupThreads, now_s: float) -> None:
        self._node = node
        self._cpu_s: float | None = None
        self._before_s: dict[int, float] = {}
        self._deadline_s = now_s + TICK_S
        self._request_s = now_s + REQUEST_EVERY_S

    def ended(self, now_s: float) -> bool:
        """Return whether the node has used too much CPU time, or the maximum wall time has passed.

        Only the CPU time that is used after the first reading counts.
        """
        if now_s < self._request_s:
            return False
        self._request_s = now_s + REQUEST_EVERY_S
        if self._cpu_s is None:
            self._cpu_s = self._node.run_time_s()
            self._before_s = self._node.run_times_s()
        return now_s > self._deadline_s or self._node.run_time_s() - self._cpu_s > TICK_CPU_S

    def would_be_late(self) -> bool:
        """Return whether the node has computed for longer than LATE_CPU_S since the first reading."""
        return self._cpu_s is not None and self._node.run_time_s() - self._cpu_s > LATE_CPU_S

    def several_worked(self) -> bool:
        """Return whether several threads of the program shared the work. If not, one thread has a loop without a pause.

        In rclpy's MultiThreadedExecutor, it is not predictable which threads do the work. Until a thread begins to run
        a callback, the executor submits the same callback again and again, and wakes a thread each time.
        """
        worked_s = sorted(at_s - self._before_s.get(tid, 0.0) for tid, at_s in self._node.run_times_s().items())
        return len(worked_s) > 1 and worked_s[-2] >= SHARED * sum(worked_s)
