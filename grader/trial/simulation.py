"""Simulation: the ROS side of a trial, with simulator, recorder and the process of the node, whatever the clock."""

from __future__ import annotations

import time
from contextlib import suppress
from typing import TYPE_CHECKING

import rclpy
from rclpy.executors import SingleThreadedExecutor, TimeoutException
from rclpy.service import Service
from rclpy.subscription import Subscription

from grader.trial.recorder import Recorder
from grader.turtlesim.node import TurtlesimNode
from grader.turtlesim.turtle import FRAME_S, Start

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

    from rclpy.node import Node

    from grader.trial.crowd import Stalls
    from grader.trial.inputs import Inputs
    from grader.trial.node_process import NodeProcess
    from grader.trial.recording import Pose

COMMANDS = "/turtle1/cmd_vel"
PUBLISHED = {"/turtle1/pose": "turtlesim/msg/Pose", "/turtle1/color_sensor": "turtlesim/msg/Color"}
_MOST_AT_ONCE = 2000
"""The most callbacks before the trial looks at its clock again: a flood of messages must not stop time."""
_MOST_AT_ONCE_S = 0.5
_MOST_INTERVENTIONS = 1000
"""The most interventions that are kept in order. After these, each name is kept once, and the others are counted."""


class Simulation:
    """The ROS side of a trial. `frame` moves the turtle, `spin` handles what has arrived.

    An executor looks at every service and every event each time, which takes longer than anything else in a frame.
    `hear` only takes messages. It is enough as long as no other node `may_ask` for a service.
    """

    def __init__(
        self, node: NodeProcess, start: Pose, prefixes: list[Path], inputs: Inputs, judged: Collection[str] = ()
    ) -> None:
        """`judged` are the topics that a check needs."""
        # Our own log lines go to /rosout, for the recorder, and not to disk: a node that makes the simulator log must
        # not fill it.
        rclpy.init(args=["--ros-args", "--disable-external-lib-logs", "--disable-stdout-logs"])
        self.node = node
        self.inputs = inputs
        self.interventions: list[str] = []
        self.interventions_dropped = 0
        simulated = {**PUBLISHED, "/clock": "rosgraph_msgs/msg/Clock"}
        self.recorder = Recorder(self.now, prefixes, simulated, (COMMANDS, *PUBLISHED, *judged))
        self.turtlesim = TurtlesimNode(
            start=Start(start.x, start.y, start.theta),
            pose_every=inputs.pose_every,
            cli_args=["--ros-args", *(part for rule in inputs.rename for part in ("-r", rule))],
            on_command=self.recorder.keep_command,
            on_publish=self.recorder.keep,
            on_intervention=self._intervened,
        )
        leave_out_events(self.recorder)
        leave_out_events(self.turtlesim)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.turtlesim)
        self.executor.add_node(self.recorder)
        self.frames: list[tuple[float, float, float, float, float, float, bool]] = []
        self.doubts: list[str] = []
        self.stalls: list[tuple[float, float]] = []
        self.watch: Stalls | None = None
        self.requests = 0
        """How many requests of services and actions were answered."""
        self.seconds: dict[str, float] = {}
        self._since = time.monotonic()
        self._services: list[str] = []

    def lap(self, part: str) -> None:
        """Keep the duration of the part that ends now."""
        now = time.monotonic()
        self.seconds[part] = now - self._since
        self._since = now

    def close(self) -> None:
        """Leave the ROS graph."""
        rclpy.try_shutdown()

    def now(self) -> float:
        """Return the time on the trial's clock (s)."""
        raise NotImplementedError

    def crowded(self) -> bool:
        """Return whether other programs kept simulator and node from running; simulated time does not care."""
        return False

    def worked_for_node_s(self, begin_s: float, end_s: float) -> float:
        """Return the CPU time that the simulator spent for the node between two times on the trial's clock (s)."""
        return 0.0 if self.watch is None else self.watch.worked_for_node_s(begin_s, end_s)

    def frame(self, now_s: float) -> None:
        """Make one frame of the simulator, and keep it."""
        drive = self.inputs.drive(now_s)
        if drive is not None and self.turtlesim.turtle_state("turtle1") is not None:
            self.turtlesim.world.command("turtle1", drive[0], 0.0, drive[1])
        self.turtlesim.frame(now_s)
        state = self.turtlesim.turtle_state("turtle1")
        if state is not None:
            self.frames.append(
                (now_s, state.x, state.y, state.theta, state.linear, state.angular, state.wall),
            )

    def spin(self, timeout_s: float = 0.0) -> list[object]:
        """Handle all that has arrived, and wait up to `timeout_s` for the first. Return the entities that it came by.

        An entity is a subscription for one or more messages, a service for each request, and so on.
        """
        handled: list[object] = []
        until = time.monotonic() + timeout_s + _MOST_AT_ONCE_S
        while time.monotonic() < until and len(handled) < _MOST_AT_ONCE:
            some = self._handle_ready(0.0 if handled else timeout_s)
            handled += some
            # While the simulator answers a request, it may log something for the recorder.
            if all(isinstance(source, Subscription) for source in some):
                break
        return handled

    def may_ask(self) -> bool:
        """Return whether any node has a client of one of our services or actions."""
        if not self._services:
            self._services = [
                name
                for node in (self.turtlesim, self.recorder)
                for name, _ in node.get_service_names_and_types_by_node(node.get_name(), node.get_namespace())
            ]
        # Not Node.count_clients: it validates the name each time, which takes four times as long.
        count = self.turtlesim.handle.get_count_clients
        return any(count(name) for name in self._services)

    def hear(self) -> None:
        """Handle the messages that have arrived."""
        for node in (self.turtlesim, self.recorder):
            for subscription in list(node.subscriptions):
                _handle_messages(subscription)

    def _handle_ready(self, timeout_s: float) -> list[object]:
        """Handle what is ready now, or the first within `timeout_s`, and further messages on the same topics."""
        handled: list[object] = []
        with suppress(TimeoutException):
            while len(handled) < _MOST_AT_ONCE:
                handler, source, _ = self.executor.wait_for_ready_callbacks(0.0 if handled else timeout_s)
                handler()
                handler.result()
                handled.append(source)
                if isinstance(source, Subscription):
                    _handle_messages(source)  # the executor takes one at a time
                else:
                    self.requests += isinstance(source, Service)
                    self._services = []  # a turtle may have been added or removed
        return handled

    def students_nodes(self) -> list[str]:
        """Return the nodes in the graph that are not ours, by name."""
        others: list[str] = self.recorder.nodes()
        others.remove(self.turtlesim.get_fully_qualified_name())
        return others

    def _intervened(self, name: str) -> None:
        # A thousand calls of a harmless service must not hide the next teleport.
        if len(self.interventions) < _MOST_INTERVENTIONS or name not in self.interventions:
            self.interventions.append(name)
        else:
            self.interventions_dropped += 1

    def wind_down(self) -> None:
        """Send Ctrl-C to the node and continue, in wall time, until it has ended."""
        self.node.interrupt()
        begun, from_s = time.monotonic(), self.now()
        frames = 0
        while not self.node.ended():
            if time.monotonic() - begun >= frames * FRAME_S:
                self.tick(from_s + frames * FRAME_S)
                frames += 1
            self.spin(0.004)
            self.node.read_output(self.now())
            self.node.escalate()
        self.spin()
        self.node.read_output(self.now())

    def tick(self, now_s: float) -> None:
        """Make one frame, and publish the time if this clock does so."""
        self.frame(now_s)


def _handle_messages(subscription: Subscription) -> None:
    """Pass the waiting messages to their callbacks."""
    with subscription.handle:
        for _ in range(_MOST_AT_ONCE):
            taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
            if taken is None:
                break
            subscription.callback(taken[0])


def leave_out_events(node: Node) -> None:
    """Do not wait for events (other types, other QoS) on the topics of a node, except on those of the turtle.

    rclpy passes every source of events to every wait. Topics that the node joins later keep their events.
    """
    for endpoint in (*node.publishers, *node.subscriptions):
        if not endpoint.topic_name.startswith("/turtle1/"):
            for handler in endpoint.event_handlers:
                node.remove_waitable(handler)
