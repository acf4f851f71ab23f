"""A trial in wall time.

If a result in simulated time is in doubt, the result in wall time counts. A node that does not follow ROS time can be
judged only in wall time.
"""

from __future__ import annotations

import time
from contextlib import closing, suppress

from grader.trial.crowd import Others, Stalls, is_crowded, is_machines
from grader.trial.node_group import GroupThreads
from grader.trial.patience import HandshakePatience
from grader.trial.rest import GoneError
from grader.trial.simulation import Simulation
from grader.trial.system_clock import SystemClock
from grader.turtlesim.turtle import FRAME_S

DISCOVERY_S = 10.0
"""The maximum time that a node may sleep, and the maximum CPU time that it may use, until it is in the graph (s)."""
GRAPH_EVERY = 31


class WallTrial(Simulation):
    """A simulation on CLOCK_MONOTONIC.

    A late frame runs immediately, and no frame is skipped.
    """

    _begun: float | None = None
    _crowded = False

    def now(self) -> float:
        """Return the time since the start of the scenario (s)."""
        return 0.0 if self._begun is None else time.monotonic() - self._begun

    def run(self, duration_s: float) -> float:
        """Run the scenario, and return the time of SIGINT, or of the node's own exit, on the trial's clock (s)."""
        self.lap("start")
        clock = SystemClock()
        self._discover()
        self.lap("discovery")
        self._begun = time.monotonic()
        watch = self.watch = Stalls(*self.node.pids)
        others = Others()
        frame = 0
        while frame * FRAME_S < duration_s and not self.node.ended() and not self.is_over(frame * FRAME_S):
            early_s = frame * FRAME_S - self.now()
            if early_s > 0:
                self.spin(early_s)
                self.node.read_output(self.now())
                continue
            clock.was_set()
            stall = watch.look(self.now())
            if stall is not None:
                self.stalls.append(stall)
            self.frame(frame * FRAME_S)
            frame += 1
            if frame % GRAPH_EVERY == 1:
                self.follow_graph()
                self.recorder.snapshot()
        stopped_s = self.now()
        watch.close()
        worked_s = self.node.worked_s(self._begun, time.monotonic())
        others_s = others.worked_s(but_s=worked_s)
        self._crowded = is_crowded(watch.waited_s, others_s, of_s=stopped_s)
        if not is_machines(sum(end - begin for begin, end in self.stalls), others_s):
            self.stalls.clear()
        if clock.was_set():
            self.unreliable = ((0.0, stopped_s),)
        self.recorder.snapshot()
        self.lap("run")
        self.wind_down()
        self.lap("stop")
        return stopped_s

    def crowded(self) -> bool:
        """Return whether the simulator and the node often had to wait for a processor because of other programs."""
        return self._crowded

    def _discover(self) -> None:
        """Wait until the node is in the graph and its topics are recorded, until it has exited, or for DISCOVERY_S.

        The first command ends the wait immediately, since the turtle moves after this command. On a crowded machine, a
        node may need much longer to start, so the time for which it waits for a processor does not count.
        """
        patience = HandshakePatience(time.monotonic(), DISCOVERY_S)
        with suppress(GoneError), closing(GroupThreads(self.node.pids)) as threads:
            while not self.node.ended():
                self.spin(0.01)
                wrote = self.node.read_output(self.now()) > 0
                if self.recorder.commands:
                    return
                if self.all_nodes_found() and not self.follow_graph():
                    break
                asleep, worked_s = threads.look().asleep, threads.run_time_s()
                if patience.ended(time.monotonic(), asleep=asleep, wrote=wrote, worked_s=worked_s):
                    break
        # Handle earlier arrivals before the clock starts, so that no interval contains them. Reading the graph is slow.
        self.spin()
        self.node.read_output(self.now())
