"""A trial without a node: the simulator runs its frames as fast as it can."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, cast

from grader.trial.recording import Output, ProcessEnd, Recording, frames_of
from grader.trial.simulation import Simulation
from grader.turtlesim.turtle import FRAME_S

if TYPE_CHECKING:
    from pathlib import Path

    from grader.trial.inputs import Inputs
    from grader.trial.node_group import NodeGroup
    from grader.trial.recording import Pose

GRAPH_S = 5.0
"""The maximum time to wait until the recorder finds the topics of the simulator in the graph (s)."""


class AloneTrial(Simulation):
    """A simulation without a node. Each frame advances its clock by the length of a frame."""

    def __init__(self, start: Pose, prefixes: list[Path], inputs: Inputs) -> None:
        self._now_s = 0.0
        # There is no node, and `record` does not need one.
        super().__init__(cast("NodeGroup", None), start, prefixes, inputs)
        self._start = start

    def now(self) -> float:
        """Return the time of the last frame (s)."""
        return self._now_s

    def record(self, duration_s: float, seed: int | None) -> Recording:
        """Run the scenario, and return the recording."""
        deadline = time.monotonic() + GRAPH_S
        while not self.recorder.follow_graph() and time.monotonic() < deadline:
            self.spin(0.01)
        for frame in range(round(duration_s / FRAME_S) + 1):
            self._now_s = frame * FRAME_S
            self.frame(self._now_s)
            self.spin()
        self.recorder.snapshot()
        recorder = self.recorder
        return Recording(
            clock="simulated",
            why="",
            seed=seed,
            start=self._start,
            duration_s=duration_s,
            sigint_t_s=self._now_s,
            messages=tuple(recorder.messages),
            dropped=recorder.dropped,
            commands=tuple(recorder.commands),
            frames=frames_of(self.frames),
            log=tuple(recorder.log),
            graphs=tuple(recorder.graphs),
            topics={topic: tuple(sorted(types)) for topic, types in sorted(recorder.topics.items())},
            stdout=Output(""),
            stderr=Output(""),
            end=ProcessEnd("SIGINT", 0, self._now_s, 0.0),
        )
