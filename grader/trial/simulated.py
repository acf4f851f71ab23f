"""A trial in simulated time: before /clock advances, the trial waits until the node is idle.

The clock stays at 0 until the simulator and the node have discovered each other (the handshake). After this handshake,
the clock advances in frames of 16 ms, and the node gets the time of each frame in which it may have something to do
(pauses.py). The threads of a node show whether the node follows wall time. Any sign that the node follows wall time, or
never becomes idle, is called a doubt. With `--clock auto`, a doubt usually leads to a trial in wall time
(grading/clock.py; docs/design.md, decision 3).
"""

from __future__ import annotations

import os
import time
from typing import TYPE_CHECKING

from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from rosgraph_msgs.msg import Clock

from grader.common.linux_calls import sleep_precisely
from grader.trial.node_group import GroupThreads, cpu_ns_at_rest
from grader.trial.patience import HandshakePatience, TickPatience
from grader.trial.pauses import Pauses
from grader.trial.rest import DoubtError, GoneError, Threads, not_of_dds, of_dds, receives
from grader.trial.simulation import Simulation
from grader.trial.wait import HIDDEN, doubt
from grader.turtlesim.turtle import FRAME_S

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

    from grader.trial.inputs import Inputs
    from grader.trial.node_group import NodeGroup
    from grader.trial.recording import Pose

QUIET_S = 0.02
"""The time without discovery traffic after which discovery counts as finished (s). The simulator and the node must
leave gaps of this length, so it is less than half the time between two announcements (fastdds.xml)."""
WAKE_S = 1.0
"""The maximum time to wait until each node has reacted to /clock at time 0 (s)."""
MOST_CPU = 2.0
"""If the CPU time of all nodes together exceeds this multiple of the trial's duration, the nodes would also be too slow
in wall time. Therefore, their result must come from a trial in wall time."""
GRAPH_EVERY = 31
"""The number of frames between two checks of the graph and of the DDS events (half a second)."""
OWN_EVERY = 5
"""The number of frames between two checks for work that no message from a node announces, such as log messages of the
simulator and the steps of an action."""
WAITS_EVERY = 7
"""The number of frames between two checks of what the node's threads are waiting for."""
ENDING_S = 0.5
"""The time limit for a sleeping node to exit (s of wall time). If the node has not exited by then, its sleep is taken
as a sign that it follows wall time."""
LEAVING_S = 3.0
"""The same limit for a node that has left the graph. The clock stands still during this time."""
_POLL_S = 0.00005


class SimulatedTrial(Simulation):
    """A simulation that publishes /clock, whose time the node follows."""

    held = True

    def __init__(
        self,
        node: NodeGroup,
        start: Pose,
        prefixes: list[Path],
        inputs: Inputs,
        judged: Collection[str] = (),
        *,
        stop_at_doubt: bool,
    ) -> None:
        self._now_s = 0.0
        self._followers = 0
        self._stop_at_doubt = stop_at_doubt
        super().__init__(node, start, prefixes, inputs, judged)
        qos = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._clock = self.recorder.create_publisher(Clock, "/clock", qos)
        self._time = Clock()

    def now(self) -> float:
        """Return the current time on /clock (s)."""
        return self._now_s

    def run(self, duration_s: float) -> float:
        """Run the scenario, and return the time of SIGINT, or of the node's own exit, on the trial's clock (s).

        Raises:
            DoubtError: simulated time may misjudge the node, and the plan sets `stop_at_doubt`.
        """
        sleep_precisely()
        try:
            self.lap("start")
            self._handshake()
            self.lap("discovery")
            pauses, paused_until_s = Pauses(self), 0.0
            for frame in range(1, (last := round(duration_s / FRAME_S)) + 1):
                self._now_s = frame * FRAME_S
                if self._now_s < paused_until_s and frame % GRAPH_EVERY and frame != last:
                    self.frame(self._now_s)
                else:
                    self.tick(self._now_s)
                    self._settle()
                    self._await_leaver()
                    paused_until_s = self._now_s + pauses.pause_s()
                if frame % OWN_EVERY == 0:
                    self._take_in(requests=False)
                if frame % GRAPH_EVERY == 0:
                    self.spin()
                    self.follow_graph()
                    self.recorder.snapshot()
                    if self._node.run_time_s() > MOST_CPU * duration_s:
                        self._doubt("the node uses too much CPU time")
                        break
                if frame % WAITS_EVERY == 0:
                    self._doubt_sleepers()
                if self.is_over(self._now_s):
                    break
        except GoneError:
            self.spin()
        self.recorder.snapshot()
        stopped_s = self._now_s
        self.lap("run")
        self.wind_down()
        self.lap("stop")
        return stopped_s

    def _doubt(self, why: str, *, by_chance: bool = False) -> None:
        if why not in self.doubts:
            self.doubts.append(why)
        if self._stop_at_doubt:
            raise DoubtError(why, by_chance=by_chance)

    def tick(self, now_s: float) -> None:
        """Run one frame and publish its time."""
        self._now_s = now_s
        self.frame(now_s)
        self._publish_clock(now_s)

    def _publish_clock(self, now_s: float) -> None:
        stamp = self._time.clock
        stamp.sec, stamp.nanosec = divmod(round(now_s * 1e9), 1_000_000_000)
        self._clock.publish(self._time)

    # --- rest -------------------------------------------------------------------------------------------------

    def _watch(self) -> None:
        self._node = GroupThreads(self.node.pids)
        self._own = Threads(os.getpid(), of_dds)
        self._received: tuple[int, ...] = ()
        self._handled: tuple[int, ...] = ()

    def _rest(self, patience: TickPatience) -> bool:
        """Before the clock advances, wait until neither the node nor the simulator has anything left to do.

        Return False if this takes longer than `patience` allows: threads that wake each other appear asleep each time.
        """
        while True:
            # The main thread usually works longest. While it works, the other threads need not be checked.
            cpu_ns = cpu_ns_at_rest(self._node, self._own) if self._node.main_asleep() else None
            if cpu_ns is None:
                time.sleep(_POLL_S)
            elif not self.node.waited_to_write(self.node.read_output(self._now_s)):
                self._received = self._own.only(cpu_ns[-1], receives)
                return True
            if patience.ended(time.monotonic()):
                return False

    def _settle(self) -> None:
        """Let the node and the simulator respond to each other until both are idle."""
        patience = TickPatience(self._node, time.monotonic())
        time.sleep(_POLL_S)  # the clock has just advanced, and the node must first wake up
        self._respond(patience)
        if patience.would_be_late():
            self._doubt("the node computes for so long that it would be late in wall time", by_chance=True)

    def _respond(self, patience: TickPatience) -> None:
        while True:
            if not self._rest(patience):
                if patience.several_worked():
                    self._doubt("the node never becomes idle: its threads keep waking each other up", by_chance=True)
                else:
                    self._doubt("the node is always busy: it seems to have a loop without a pause")
                return
            # The simulator's receiving threads have not run since the last time, so no new message has arrived.
            if self._received == self._handled:
                return
            self._handled = self._received
            if not self._take_in():
                return

    def _take_in(self, *, requests: bool = True) -> bool:
        """Handle what has arrived. Without `requests`, requests may wait. Return whether the node may react to it."""
        # Plain messages and acknowledgements get no response, so the node stays idle.
        if not self.may_act():
            return self.take_in(requests=requests) > 0
        return not all(isinstance(source, Subscription) for source in self.spin())

    # --- handshake --------------------------------------------------------------------------------------------

    def _handshake(self) -> None:
        self._watch()
        patience = HandshakePatience(time.monotonic())
        while not self._found_each_other():
            if self.node.ended():
                raise GoneError
            asleep, worked_s = self._node.look().asleep, self._node.run_time_s()
            wrote = self.node.read_output(0.0) > 0
            if patience.ended(time.monotonic(), asleep=asleep, wrote=wrote, worked_s=worked_s):
                self._doubt("the node did not begin to wait for its clock, so the clock could not start")
                return
        self._watch()  # threads get their names when they first run
        self._wake()
        if len(self.recorder.commands) >= 2:
            self._doubt("the node published several commands while the clock stood still")
        self._doubt_sleepers()
        self.follow_graph()
        self.recorder.snapshot()
        self.tick(0.0)

    def _found_each_other(self) -> bool:
        """Wait up to QUIET_S. Return whether there was no discovery traffic and the node is waiting for its clock."""
        quiet = GroupThreads(self.node.pids, of_dds)
        try:
            before = quiet.look().runs
            silent_s = time.monotonic()
            while time.monotonic() - silent_s < QUIET_S:
                if self.spin(0.004):
                    return False
                look = quiet.look()
                if look.runs != before or not look.asleep:
                    return False
        finally:
            quiet.close()
        if not before or self.follow_graph():
            return False
        amount = len(self.node.pids)
        main = [wait for wait in self._node.waits() if wait.tid in self.node.pids]
        waits = len(main) == amount and all(wait.call == "futex" and not wait.timed for wait in main)
        return waits and self.all_nodes_found() and self._clock.get_subscription_count() >= amount

    def _wake(self) -> None:
        """Publish time 0 until each node has woken up twice, or WAKE_S has passed.

        When each node has woken up twice, the simulator and the nodes have discovered each other.
        """
        rest = GroupThreads(self.node.pids, not_of_dds)
        try:
            before = rest.looks()
            wakes = [0 for _ in before]
            deadline = time.monotonic() + WAKE_S
            while min(wakes) < 2 and time.monotonic() < deadline:
                self._publish_clock(0.0)
                self._settle()
                looks = rest.looks()
                wakes = [count + (now.runs != last.runs) for count, now, last in zip(wakes, looks, before, strict=True)]
                before = looks
                if min(wakes) < 2:
                    self.spin(0.005)
        finally:
            rest.close()

    def _doubt_sleepers(self) -> None:
        waits = self._node.waits()
        if any(wait.call == HIDDEN for wait in waits):
            self._doubt("the node hides what it waits for")
        why = doubt(waits, len(self.node.pids))
        if why is None and self.node.has_started_others():
            why = "the node has started another process, which may need wall time"
        if why is not None and not self._is_ending():
            self._doubt(why)

    def _await_leaver(self) -> None:
        """If a node has just stopped following /clock, wait for its process to exit, which takes wall time.

        Raises:
            GoneError: the process has exited.
        """
        before, self._followers = self._followers, self._clock.get_subscription_count()
        if self._followers < len(self.node.pids) <= before and self._is_ending(LEAVING_S):
            raise GoneError

    def _is_ending(self, limit_s: float = ENDING_S) -> bool:
        """Return whether the node exits within the time limit.

        A node that shuts down after an exception may sleep for a moment, which does not mean that it needs wall time.
        """
        deadline = time.monotonic() + limit_s
        while time.monotonic() < deadline:
            self.node.read_output(self._now_s)
            if self.node.ended():
                return True
            time.sleep(_POLL_S)
        return False
