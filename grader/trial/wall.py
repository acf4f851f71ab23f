"""A trial in wall time: the reference, and the only judge of a node that does not follow ROS time."""

from __future__ import annotations

import os
import time
from pathlib import Path

from grader.simulator.turtle import FRAME_S
from grader.trial.rest import GoneError, Threads
from grader.trial.stage import Stage

DISCOVERY_S = 10.0
GRAPH_EVERY = 31
STALL_S = 0.03
"""Time that the machine owed to simulator or node between two frames: from here on, arrivals are not to be trusted."""
OWN_DOING = 0.5
"""A node that itself used this share of the time and more kept itself waiting: that is no stall."""
OTHERS = 0.2
"""Others use the machine when they take this share of one processor and more ..."""
WAITED = 0.05
"""... and crowd it when simulator and node together wait for a processor this share of the time and more."""
_TICK_S = 1.0 / os.sysconf("SC_CLK_TCK")


class WallTrial(Stage):
    """A stage on CLOCK_MONOTONIC. Frames keep their schedule: a late one is caught up, never left out."""

    _begun: float | None = None
    _crowded = False

    def now(self) -> float:
        """Return the time since the scenario began (s)."""
        return 0.0 if self._begun is None else time.monotonic() - self._begun

    def run(self, duration_s: float) -> float:
        """Run the scenario; return when SIGINT was sent, on the trial's clock (s)."""
        self.lap("start")
        self._discover()
        self.lap("discovery")
        self._begun = time.monotonic()
        watch = _Stalls(self.node.pid)
        others = _Others()
        frame = 0
        while frame * FRAME_S < duration_s and not self.node.ended():
            early_s = frame * FRAME_S - self.now()
            if early_s > 0:
                self.spin(early_s)
                self.node.read_output(self.now())
                continue
            stall = watch.look(self.now(), late_s=-early_s)
            if stall is not None:
                self.stalls.append(stall)
            self.frame(frame * FRAME_S)
            frame += 1
            if frame % GRAPH_EVERY == 0:
                self.recorder.follow_graph()
                self.recorder.snapshot()
        stopped_s = self.now()
        worked_s = self.node.worked_s(self._begun, time.monotonic())
        self._crowded = watch.waited_s >= WAITED * stopped_s and others.worked_s(but_s=worked_s) >= OTHERS * stopped_s
        self.recorder.snapshot()
        self.lap("run")
        self.wind_down()
        self.lap("stop")
        return stopped_s

    def crowded(self) -> bool:
        """Whether other programs used the machine so much that simulator and node often had to wait."""
        return self._crowded

    def _discover(self) -> None:
        """Let the clock start when the node is in the graph and its topics are recorded, or has ended."""
        deadline = time.monotonic() + DISCOVERY_S
        while time.monotonic() < deadline and not self.node.ended():
            self.spin(0.01)
            self.node.read_output(self.now())
            if self.students_nodes() and not self.recorder.follow_graph():
                break
        self.recorder.snapshot()


class _Stalls:
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


class _Others:
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
