"""Use /proc to measure whether the simulator and the node get the CPU time that a trial in wall time needs."""

from __future__ import annotations

import os
import time
from pathlib import Path

from grader.trial.node_group import GroupThreads
from grader.trial.rest import GoneError

STALL_S = 0.03
"""If the simulator or the node had to wait longer than this between two frames (s), arrival times are unreliable."""
LONG_S = 0.3
"""If a thread waited for a processor for at least this time (s), the turtle may have stopped or left its path
meanwhile. Then the whole wait is a stall, and not only the frame in which it ended."""
OWN_DOING = 0.5
"""If a node or the simulator used a processor for more than this share of the time, the node delayed itself, so the
delay is not a stall. Work that the node causes in the simulator counts as work of the node. For example, the machine is
not to blame if the simulator is late because it responds to thousands of calls.
"""
SIMULATOR = 0.3
"""The share of a processor that the simulator may use for itself. In measurements, the simulator used a tenth of a
processor. CPU time beyond this share counts as work for the node."""
OTHERS = 0.2
"""Other programs are considered to use the machine if they take at least this share of one processor."""
WAITED = 0.05
"""The machine is crowded if other programs use it, and the simulator and the node together wait for a processor for at
least this share of the time."""
_TICK_S = 1.0 / os.sysconf("SC_CLK_TCK")

Times = dict[int, tuple[float, float]]
"""Maps the id of a thread to the times for which it has run and waited for a processor (s)."""


def is_crowded(waited_s: float, others_s: float, *, of_s: float) -> bool:
    """Return whether other programs keep the machine so busy that they disturb the trial.

    In a period of `of_s` (s), the other programs used `others_s` (s) of CPU time, and the simulator and the node waited
    for a processor for `waited_s` (s).
    """
    return waited_s >= WAITED * of_s and others_s >= OTHERS * of_s


def is_machines(stalled_s: float, others_s: float) -> bool:
    """Return whether the machine can be at fault for stalls of this total length (s).

    A thread waits for a processor only while something else is using the processor. If the other programs used less CPU
    time than the stalls lasted, the threads of the node delayed each other. This happens, for example, in a node that
    publishes without a pause.
    """
    return others_s >= stalled_s


class Stalls:
    """Finds stalls. The kernel measures the time for which threads were ready to run but did not run."""

    def __init__(self, *pids: int) -> None:
        self._parts = [_threads(*pids), _threads(os.getpid())]
        self._before: list[Times] = [{}, {}]
        self._stolen_s = _stolen_s()
        self._since_s = self._stalled_until_s = 0.0
        self._for_node: list[tuple[float, float]] = []
        self.waited_s = 0.0
        self.look(0.0)
        self._for_node = [(0.0, 0.0)]
        self.waited_s = 0.0
        """The time for which the simulator and the node have waited for a processor so far (s), summed over all
        threads."""

    def close(self) -> None:
        """Close the threads' files in /proc. After that, `look` must not be called."""
        for threads in self._parts:
            if threads is not None:
                threads.close()

    def look(self, now_s: float) -> tuple[float, float] | None:
        """Return the period of the stall that was found since the last call (from, to, in s), or None.

        In a stall, threads waited for a processor for more than STALL_S, or the hypervisor gave the processor to
        another virtual machine for more than STALL_S. The kernel counts a wait when it ends, so the stall begins at the
        last call or, if a thread has waited for LONG_S or longer, where this wait began. If the node kept a processor
        busy (OWN_DOING), the waits of the threads do not count. A late frame alone is not a stall, because a node that
        keeps the simulator busy could cause the delay.
        """
        now = [_times(threads) for threads in self._parts]
        (node_s, node_waited_s, node_longest_s), (simulator_s, simulator_waited_s, simulator_longest_s) = (
            _since(*pair) for pair in zip(self._before, now, strict=True)
        )
        self._before = now
        self.waited_s += node_waited_s + simulator_waited_s
        passed_s = max(now_s - self._since_s, 1e-3)
        for_node_s = max(0.0, simulator_s - SIMULATOR * passed_s)
        if for_node_s > 0.0:
            self._for_node.append((now_s, for_node_s))
        longest_s = max(node_longest_s, simulator_longest_s)
        if longest_s < LONG_S:
            longest_s = 0.0
        own_doing = max(node_s + for_node_s, simulator_s) > OWN_DOING * max(passed_s, longest_s)
        stolen_s = _stolen_s()
        owed = [stolen_s - self._stolen_s, *([] if own_doing else [node_waited_s, simulator_waited_s])]
        self._stolen_s = stolen_s
        begun_s, self._since_s = self._since_s, now_s
        if max(owed) <= STALL_S:
            return None
        if not own_doing:
            begun_s = min(begun_s, now_s - longest_s)
        begun_s, self._stalled_until_s = max(begun_s, self._stalled_until_s), now_s
        return begun_s, now_s

    def worked_for_node_s(self, begin_s: float, end_s: float) -> float:
        """Return the CPU time (s) that the simulator spent on the node between two times."""
        return sum(spent_s for at_s, spent_s in self._for_node if begin_s < at_s <= end_s)


class Others:
    """Measures the CPU time of all other programs on this machine since the creation of this object."""

    def __init__(self) -> None:
        self._before = _machine_worked_s() - time.process_time()

    def worked_s(self, *, but_s: float) -> float:
        """Return the CPU time (s) of all other processes since the creation of this object, minus `but_s` (s).

        CPU time that other virtual machines on the same hardware used is included.
        """
        return _machine_worked_s() - time.process_time() - self._before - but_s


def _threads(*pids: int) -> GroupThreads | None:
    try:
        return GroupThreads(pids)
    except GoneError:
        return None


def _times(threads: GroupThreads | None) -> Times:
    if threads is None:
        return {}
    try:
        return threads.times_s()
    except GoneError:
        return {}


def _since(before: Times, now: Times) -> tuple[float, float, float]:
    """Return how long all threads ran and waited between two measurements, and the longest wait of a thread (s)."""
    ran_s = waited_s = longest_s = 0.0
    for tid, (ran_until_s, waited_until_s) in now.items():
        ran_before_s, waited_before_s = before.get(tid, (0.0, 0.0))
        ran_s += ran_until_s - ran_before_s
        waited_s += waited_until_s - waited_before_s
        longest_s = max(longest_s, waited_until_s - waited_before_s)
    return ran_s, waited_s, longest_s


def _stolen_s() -> float:
    """Return the total time for which other virtual machines on the same hardware used the processors (s)."""
    return _machine_s()[7]


def _machine_worked_s() -> float:
    user, nice, system, _idle, _iowait, irq, softirq, steal = _machine_s()
    return user + nice + system + irq + softirq + steal


def _machine_s() -> list[float]:
    """Return the total times of all processors (s). The times are the columns of the file /proc/stat (see proc(5))."""
    return [int(column) * _TICK_S for column in Path("/proc/stat").read_text().split(maxsplit=9)[1:9]]
