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
_TICK_S = 1.0 / os.sysconf("SC_CLK_TCK")


class WallTrial(Stage):
    """A stage on CLOCK_MONOTONIC. Frames keep their schedule: a late one is caught up, never left out."""

    _begun: float | None = None

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
        self.recorder.snapshot()
        self.lap("run")
        self.wind_down()
        self.lap("stop")
        return stopped_s

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
        self.look(0.0, late_s=0.0)

    def look(self, now_s: float, *, late_s: float) -> tuple[float, float] | None:
        """Look at the time since the last look; the stall that fell into it, if any. `late_s`: of this frame."""
        passed_s = max(now_s - self._since_s, 1e-3)
        owed = [late_s]
        for index, threads in enumerate(self._parts):
            ran_s, waited_s = _times(threads)
            before_ran_s, before_waited_s = self._before[index]
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
    return int(Path("/proc/stat").read_text().split(maxsplit=10)[8]) * _TICK_S
