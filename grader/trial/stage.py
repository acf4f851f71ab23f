"""The stage of a trial: simulator, recorder and the node's process in one place, whatever the clock."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import rclpy
from rclpy.executors import SingleThreadedExecutor, TimeoutException

from grader.simulator.node import TurtlesimNode
from grader.simulator.turtle import FRAME_S
from grader.trial.recorder import Recorder

if TYPE_CHECKING:
    from pathlib import Path

    from grader.recording import Pose
    from grader.trial.node_process import NodeProcess

PUBLISHED = {"/turtle1/pose": "turtlesim/msg/Pose", "/turtle1/color_sensor": "turtlesim/msg/Color"}
_MOST_AT_ONCE = 2000
"""Callbacks handled before the trial looks at its clock again: a flood must not stop time."""


class Stage:
    """Owns the ROS side of a trial. `frame` moves the turtle, `spin` handles what has arrived."""

    def __init__(self, node: NodeProcess, start: Pose, prefixes: list[Path]) -> None:
        rclpy.init(args=[])
        self.node = node
        self.interventions: list[str] = []
        self.recorder = Recorder(self.now, prefixes, {**PUBLISHED, "/clock": "rosgraph_msgs/msg/Clock"})
        self.turtlesim = TurtlesimNode(
            start=start,
            on_command=self.recorder.keep_command,
            on_publish=self.recorder.keep,
            on_intervention=self.interventions.append,
        )
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.turtlesim)
        self.executor.add_node(self.recorder)
        self.frames: list[tuple[float, float, float, float, float, float, bool]] = []
        self.doubts: list[str] = []
        self.stalls: list[tuple[float, float]] = []
        self.seconds: dict[str, float] = {}
        self._since = time.monotonic()

    def lap(self, part: str) -> None:
        """Note how long the part took that ends now."""
        now = time.monotonic()
        self.seconds[part] = now - self._since
        self._since = now

    def close(self) -> None:
        """Leave the ROS graph."""
        rclpy.try_shutdown()

    def now(self) -> float:
        """Return the time on the trial's clock (s)."""
        raise NotImplementedError

    def frame(self, now_s: float) -> None:
        """Let the simulator make one frame, and keep it."""
        self.turtlesim.frame(now_s)
        state = self.turtlesim.turtle_state("turtle1")
        if state is not None:
            self.frames.append(
                (now_s, state.x, state.y, state.theta, state.linear, state.angular, state.wall),
            )

    def spin(self, timeout_s: float = 0.0) -> bool:
        """Handle all that has arrived, waiting up to `timeout_s` for the first of it; true if there was anything."""
        handled = 0
        while handled < _MOST_AT_ONCE:
            try:
                handler, _, _ = self.executor.wait_for_ready_callbacks(timeout_s if handled == 0 else 0.0)
            except TimeoutException:
                break
            handler()
            handler.result()
            handled += 1
        return handled > 0

    def students_nodes(self) -> list[str]:
        """Return the nodes in the graph that are not ours."""
        return [
            f"{namespace.rstrip('/')}/{name}"
            for name, namespace in self.recorder.get_node_names_and_namespaces()
            if (name, namespace) != ("turtlesim", "/") and not namespace.startswith("/_grader")
        ]

    def wind_down(self) -> None:
        """Press Ctrl-C on the node and go on, at the pace of the wall, until it is gone."""
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
        """Make one frame; a stage that publishes the time does so too."""
        self.frame(now_s)
