"""Simulation: the ROS 2 part of a trial (the simulator, the recorder and the node's process) with any clock."""

from __future__ import annotations

import time
from collections import Counter
from contextlib import suppress
from typing import TYPE_CHECKING

import rclpy
from rclpy.executors import SingleThreadedExecutor, TimeoutException
from rclpy.service import Service
from rclpy.subscription import Subscription

from grader.trial.arrivals import MOST_AT_ONCE, take_messages, take_requests
from grader.trial.call_log import CallLog
from grader.trial.caller import Caller
from grader.trial.goals import GoalLog
from grader.trial.recorder import Recorder
from grader.trial.recording import OUTLIVES_S
from grader.trial.silent_servers import SilentServers
from grader.trial.target_keeper import TargetKeeper
from grader.trial.turtles import TurtleWatch
from grader.turtlesim.node import TurtlesimNode
from grader.turtlesim.turtle import FRAME_S, Start

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

    from rclpy.node import Node

    from grader.trial.crowd import Stalls
    from grader.trial.inputs import Inputs
    from grader.trial.node_group import NodeGroup
    from grader.trial.observed import Call
    from grader.trial.recording import Pose

COMMANDS = "/turtle1/cmd_vel"
PUBLISHED = {"/turtle1/pose": "turtlesim/msg/Pose", "/turtle1/color_sensor": "turtlesim/msg/Color"}
_MOST_AT_ONCE_S = 0.5
"""The maximum time for which callbacks run before the trial checks its clock again (s)."""
_MOST_INTERVENTIONS = 1000
"""The maximum number of interventions (service and action calls) that are kept in order. After this number, an
intervention is kept only if its name is new. All others are only counted."""


class Simulation:
    """The part of a trial that uses ROS 2. `frame` moves the turtle, and `spin` handles everything that has arrived.

    An executor checks every entity and every event each time it runs, which takes longer than anything else in a frame.
    `take_in` handles only messages and service requests. `take_in` is sufficient while `may_act` is false, that is,
    while no other node can use an action of the simulator and no call by the trial is pending.
    """

    held = False
    """Whether the trial's clock stands still while a frame runs."""
    unreliable: tuple[tuple[float, float], ...] = ()  # the periods that count as stalls, whatever the node did in them

    def __init__(
        self, node: NodeGroup, start: Pose, prefixes: list[Path], inputs: Inputs, judged: Collection[str] = ()
    ) -> None:
        """Create the simulator and the recorder. `judged` are the topics that a check needs."""
        # The grader's log lines go to /rosout, for the recorder, and not to disk. Otherwise, a node that makes the
        # simulator log a lot could fill the disk.
        rclpy.init(args=["--ros-args", "--disable-external-lib-logs", "--disable-stdout-logs"])
        self.node = node
        self.inputs = inputs
        self.interventions: list[str] = []
        self.interventions_dropped = 0
        simulated = {**PUBLISHED, "/clock": "rosgraph_msgs/msg/Clock"}
        self.recorder = Recorder(self.now, prefixes, simulated, (COMMANDS, *PUBLISHED, *judged))
        self.goals = GoalLog(self.now)
        self._calls = CallLog(self.now)
        self.turtlesim = TurtlesimNode(
            start=Start(start.x, start.y, start.theta),
            pose_every=inputs.pose_every,
            pose_from_s=inputs.pose_from_s,
            answers_after_s=inputs.answers_after_s,
            cli_args=["--ros-args", *(part for rule in inputs.rename for part in ("-r", rule))],
            on_command=self.recorder.keep_command,
            on_publish=self.recorder.keep,
            on_intervention=self._intervened,
            on_call=self._calls.answered,
            on_goal=self.goals.add,
        )
        self.turtles = TurtleWatch(target.name for target in inputs.targets)
        self.caller = Caller(self.recorder, inputs.calls, self.now)
        self.recorder.follows_services = bool(inputs.calls)
        several = node is not None and len(node.processes) > 1
        silent = SilentServers(self.recorder, prefixes, self._calls.overheard, self.caller.sent)
        self._silent_servers = silent if several else None
        self._in_company_s: float | None = None
        leave_out_events(self.recorder)
        # Call this before other turtles exist: without its events, rclpy could not destroy a topic of a removed turtle.
        leave_out_events(self.turtlesim)
        self.keeper = TargetKeeper(self.turtlesim, inputs, self._calls.answered) if inputs.targets else None
        self.nodes: tuple[Node, ...] = tuple(filter(None, (self.turtlesim, self.recorder, self.keeper)))
        self.recorder.own_nodes = tuple(each.get_fully_qualified_name() for each in self.nodes)
        self.executor = SingleThreadedExecutor()
        for each in self.nodes:
            self.executor.add_node(each)
        self.frames: list[tuple[float, float, float, float, float, float, bool]] = []
        self.doubts: list[str] = []
        self.stalls: list[tuple[float, float]] = []
        self.watch: Stalls | None = None
        self.requests = 0
        """The number of service requests that were handled."""
        self.seconds: dict[str, float] = {}
        self._since = time.monotonic()
        self._actions: list[str] | None = None

    def lap(self, part: str) -> None:
        """Record the duration of the part of the trial that has just ended."""
        now = time.monotonic()
        self.seconds[part] = now - self._since
        self._since = now

    def close(self) -> None:
        """Leave the ROS graph."""
        rclpy.try_shutdown()

    def now(self) -> float:
        """Return the current time on the trial's clock (s)."""
        raise NotImplementedError

    def crowded(self) -> bool:
        """Return whether other programs kept the simulator and the node from running.

        Return False in simulated time, where other programs do not affect the result.
        """
        return False

    def worked_for_node_s(self, begin_s: float, end_s: float) -> float:
        """Return the CPU time that the simulator spent on the node between two times on the trial's clock (s)."""
        return 0.0 if self.watch is None else self.watch.worked_for_node_s(begin_s, end_s)

    def frame(self, now_s: float) -> None:
        """Run one frame of the simulator, and record it."""
        self.caller.make_due(now_s, spin=self.spin if self.held else None)
        drive = self.inputs.drive(now_s)
        if drive is not None and self.turtlesim.turtle_state("turtle1") is not None:
            self.turtlesim.world.command("turtle1", drive[0], 0.0, drive[1])
        if self.keeper is not None:
            self.keeper.frame(now_s)
        self.turtlesim.frame(now_s)
        self.turtles.look(now_s, self.turtlesim.world)
        if len(self.turtlesim.world.turtles) > 1:
            self._in_company_s = now_s
        self._keep_frame(now_s)

    def _keep_frame(self, now_s: float) -> None:
        state = self.turtlesim.turtle_state("turtle1")
        if state is not None:
            self.frames.append((now_s, state.x, state.y, state.theta, state.linear, state.angular, state.wall))

    def is_over(self, now_s: float) -> bool:
        """Return whether the trial ends early, because all other turtles have been gone for `alone_s` of the inputs."""
        alone_s = self.inputs.alone_s
        return alone_s is not None and self._in_company_s is not None and now_s - self._in_company_s >= alone_s

    def spin(self, timeout_s: float = 0.0) -> list[object]:
        """Handle everything that has arrived. If nothing has arrived, wait up to `timeout_s` (s).

        Return the entities whose messages or requests were handled.

        An entity is, for example, a subscription that received one or more messages, or a service that received a
        request.
        """
        handled: list[object] = []
        until = time.monotonic() + timeout_s + _MOST_AT_ONCE_S
        while time.monotonic() < until and len(handled) < MOST_AT_ONCE:
            some = self._handle_ready(0.0 if handled else timeout_s)
            handled += some
            # While the simulator answers a request, it may log something that the recorder receives.
            if all(isinstance(source, Subscription) for source in some):
                break
        return handled

    def may_act(self) -> bool:
        """Return whether a node has a client of the simulator's actions, or a call by the trial is pending."""
        if self.caller.pending:
            return True
        if self._actions is None:
            self._actions = [
                name
                for node in self.nodes
                for name, _ in node.get_service_names_and_types_by_node(node.get_name(), node.get_namespace())
                if "/_action/" in name
            ]
        # This does not use Node.count_clients, which validates the name each time and takes four times as long.
        count = self.turtlesim.handle.get_count_clients
        return any(count(name) for name in self._actions)

    def take_in(self, *, requests: bool = True) -> int:
        """Handle the messages and, with `requests`, the requests that have arrived. Return the number of requests."""
        answered = 0
        while answered < MOST_AT_ONCE:
            for subscription in [each for node in self.nodes for each in node.subscriptions]:
                take_messages(subscription)
            services = [service for node in self.nodes for service in node.services] if requests else []
            more = sum(map(take_requests, services))
            if not more:
                break
            # While the simulator answers a request, it may log something that the recorder receives.
            answered += more
        self._count_requests(answered)
        return answered

    def _count_requests(self, answered: int) -> None:
        if answered:
            self.requests += answered
            self._actions = None  # a turtle may have been added or removed

    def _handle_ready(self, timeout_s: float) -> list[object]:
        """Handle everything that is ready within `timeout_s`, and then all other messages on the same topics."""
        handled: list[object] = []
        with suppress(TimeoutException):
            while len(handled) < MOST_AT_ONCE:
                handler, source, _ = self.executor.wait_for_ready_callbacks(0.0 if handled else timeout_s)
                handler()
                handler.result()
                handled.append(source)
                if isinstance(source, Subscription):
                    take_messages(source)  # the executor takes only one message at a time
                else:
                    self._count_requests(isinstance(source, Service))
        return handled

    def follow_graph(self) -> bool:
        """Record new topics.

        With several nodes, also record the calls of new services between them. Return whether anything new was found.
        """
        fresh = self.recorder.follow_graph()
        return (self._silent_servers is not None and self._silent_servers.follow()) or fresh

    def students_nodes(self) -> list[str]:
        """Return the names of the nodes in the graph that do not belong to the grader."""
        return list((Counter(self.recorder.nodes()) - Counter(self.own_nodes)).elements())

    @property
    def own_nodes(self) -> tuple[str, ...]:
        """The names of the grader's nodes that are visible in a recording."""
        return tuple(name for name in self.recorder.own_nodes if name != self.recorder.get_fully_qualified_name())

    def all_nodes_found(self) -> bool:
        """Return whether the graph has a node for each process."""
        return len(self.students_nodes()) >= len(self.node.pids)

    @property
    def calls(self) -> tuple[Call, ...]:
        """All recorded service calls, in the order in which they were made."""
        return tuple(sorted((*self._calls.calls, *self.caller.calls), key=lambda call: call.t_s))

    def _intervened(self, name: str) -> None:
        # A thousand calls to a harmless service must not hide the next teleport.
        if len(self.interventions) < _MOST_INTERVENTIONS or name not in self.interventions:
            self.interventions.append(name)
        else:
            self.interventions_dropped += 1

    def wind_down(self) -> None:
        """Stop the nodes, and run frames in wall time until they have exited."""
        begun, from_s = time.monotonic(), self.now()
        frames = 0
        while not self.node.all_ended():
            self.node.stop()
            if time.monotonic() - begun >= frames * FRAME_S:
                self.tick(from_s + frames * FRAME_S)
                frames += 1
            self.spin(0.004)
            self.node.read_output(self.now())
        self.spin()
        self.node.read_output(self.now())
        if self.node.ended_itself():
            self._carry_out_last_command(from_s + frames * FRAME_S)

    def _carry_out_last_command(self, from_s: float) -> None:
        """After the node has exited on its own, run the frames that carry out its last command (OUTLIVES_S)."""
        for frame in range(round(OUTLIVES_S / FRAME_S) + 2):
            self.turtlesim.world.step(from_s + frame * FRAME_S)
            self._keep_frame(from_s + frame * FRAME_S)

    def tick(self, now_s: float) -> None:
        """Run one frame, and publish the time if the clock is simulated."""
        self.frame(now_s)


def leave_out_events(node: Node) -> None:
    """Ignore events (incompatible types or QoS) on a node's topics, except the topics of turtle1.

    Otherwise, rclpy would check all sources of events each time it waits. Topics that the node adds later keep their
    events.
    """
    for endpoint in (*node.publishers, *node.subscriptions):
        if not endpoint.topic_name.startswith("/turtle1/"):
            for handler in endpoint.event_handlers:
                node.remove_waitable(handler)
