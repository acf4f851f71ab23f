"""Whether a machine gives simulator and node the time that a trial in wall time needs, told from /proc."""

from __future__ import annotations

import os
import time
from pathlib import Path

from grader.trial.rest import GoneError, Threads

STALL_S = 0.03
"""Time that the machine owed to simulator or node between two frames: from here on, arrivals are not to be trusted."""
OWN_DOING = 0.5
"""A node that itself used this share of the time and more kept itself waiting: that is no stall."""
OTHERS = 0.2
"""Others use the machine when they take this share of one processor and more ..."""
WAITED = 0.05
"""... and crowd it when simulator and node together wait for a processor this share of the time and more."""
_TICK_S = 1.0 / os.sysconf("SC_CLK_TCK")


def is_crowded(waited_s: float, others_s: float, *, of_s: float) -> bool:
    """Whether others crowd the machine: `others_s` they worked, `waited_s` simulator and node waited, in `of_s` (s)."""
    return waited_s >= WAITED * of_s and others_s >= OTHERS * of_s


class Stalls:
    """Finds the stalls: the kernel tells how long threads were ready to run and did not."""

    def __init__(self, pid: int) -> None:
        self._parts = [_threads(pid), _threads(os.getpid())]
        self._before = [(0.0, 0.0), (0.0, 0.0)]
        self._stolen_s = _stolen_s()
        self._since_s = 0.0
        self.waited_s = 0.0
        self.look(0.0, late_s=0.0)
        self.waited_s = 0.0
        """How long simulator and node have waited for a processor since (s), all threads together."""

    def look(self, now_s: float, *, late_s: float) -> tuple[float, float] | None:
        """Look at the time since the last look; the stall that fell into it, if any. `late_s`: of this frame."""
        passed_s = max(now_s - self._since_s, 1e-3)
        owed = [late_s]
        for index, threads in enumerate(self._parts):
            ran_s, waited_s = _times(threads)
            before_ran_s, before_waited_s = self._before[index]
            self.waited_s += waited_s - before_waited_s
            if ran_s - before_ran_s <= OWN_DOING * passed_s:
                owed.append(waited_s - before_waited_s)
            elif index == 0:
                owed[0] = 0.0
            self._before[index] = (ran_s, waited_s)
        stolen_s = _stolen_s()
        owed.append(stolen_s - self._stolen_s)
        self._stolen_s = stolen_s
        begun_s, self._since_s = self._since_s, now_s
        return (begun_s, now_s) if max(owed) > STALL_S else None


class Others:
    """Counts what all programs of the machine but ours have worked since it was made."""

    def __init__(self) -> None:
        self._before = _machine_worked_s() - time.process_time()

    def worked_s(self, *, but_s: float) -> float:
        """CPU time of all but this process and what somebody else has worked (s)."""
        return _machine_worked_s() - time.process_time() - self._before - but_s


def _threads(pid: int) -> Threads | None:
    try:
        return Threads(pid)
    except GoneError:
        return None


def _times(threads: Threads | None) -> tuple[float, float]:
    """How long all threads have run, and waited for a processor (s)."""
    if threads is None:
        return 0.0, 0.0
    try:
        counts = [run.split() for run in threads.look().runs]
    except GoneError:
        return 0.0, 0.0
    return sum(int(ran) for ran, _, _ in counts) / 1e9, sum(int(waited) for _, waited, _ in counts) / 1e9


def _stolen_s() -> float:
    """How long other machines on the same hardware took the processors, all together (s)."""
    return _machine_s()[7]


def _machine_worked_s() -> float:
    user, nice, system, _idle, _iowait, irq, softirq, steal = _machine_s()
    return user + nice + system + irq + softirq + steal


def _machine_s() -> list[float]:
    """What the processors of the machine have done, all together (s): the columns of proc(5), /proc/stat."""
    return [int(column) * _TICK_S for column in Path("/proc/stat").read_text().split(maxsplit=9)[1:9]]
