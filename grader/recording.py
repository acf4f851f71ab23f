"""Recording: all that a trial saw, in memory."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

ClockName = Literal["simulated", "wall"]
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Pose:
    """Where a turtle is: x, y in m from the lower left corner, theta in rad, counter-clockwise from east."""

    x: float
    y: float
    theta: float


@dataclass(frozen=True)
class Message:
    """A message as it arrived.

    `data` is its CDR serialization, `t_s` the arrival on the trial's clock (s, 0 when the scenario
    starts, negative before), `mono_s` the arrival on CLOCK_MONOTONIC (s).
    """

    topic: str
    type: str
    data: bytes
    t_s: float
    mono_s: float


@dataclass(frozen=True)
class Command:
    """A geometry_msgs/msg/Twist that reached the turtle on /turtle1/cmd_vel; m/s and rad/s, x, y, z each."""

    t_s: float
    mono_s: float
    linear: tuple[float, float, float]
    angular: tuple[float, float, float]


@dataclass(frozen=True)
class LogLine:
    """A line of /rosout by arrival; `level` is DEBUG, INFO, WARN, ERROR or FATAL."""

    t_s: float
    level: str
    logger: str
    text: str


@dataclass(frozen=True)
class Endpoint:
    """A publisher or subscription in the ROS graph; `node` is the full name, as in "/draw_circle"."""

    kind: Literal["publisher", "subscription"]
    node: str
    topic: str
    type: str


@dataclass(frozen=True)
class Graph:
    """The ROS graph at time `t_s` of the trial's clock. The grader's own hidden nodes are left out; /turtlesim is in."""

    t_s: float
    nodes: tuple[str, ...]
    endpoints: tuple[Endpoint, ...]


@dataclass(frozen=True)
class Frames:
    """turtle1, one row a frame of the simulator (16 ms), from inside the simulator; arrays of shape (N,).

    `t_s` s; `x`, `y` m; `theta` rad; `linear` m/s; `angular` rad/s; `wall` true where the frame was clamped.
    """

    t_s: Floats
    x: Floats
    y: Floats
    theta: Floats
    linear: Floats
    angular: Floats
    wall: npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Output:
    """What a process wrote on one stream, decoded with replacement; `dropped` bytes beyond the cap were not kept."""

    text: str
    dropped: int = 0


@dataclass(frozen=True)
class ProcessEnd:
    """How the node's process ended.

    `by` says what it took: "itself" (before the scenario was over), or the signal after which it was gone.
    `stop_s` is the time from SIGINT to its end (s of wall time), None when it ended by itself; `t_s` is the end on
    the trial's clock. `exit_code` is negative for a signal, as in subprocess.
    """

    by: Literal["itself", "SIGINT", "SIGTERM", "SIGKILL"]
    exit_code: int
    t_s: float
    stop_s: float | None


@dataclass(frozen=True)
class Recording:
    """All that one trial saw. `why` tells in words for a beginner why this clock judged."""

    clock: ClockName
    why: str
    seed: int | None
    start: Pose
    duration_s: float
    sigint_t_s: float
    messages: tuple[Message, ...]
    commands: tuple[Command, ...]
    frames: Frames
    log: tuple[LogLine, ...]
    graphs: tuple[Graph, ...]
    topics: dict[str, tuple[str, ...]]
    """Every topic of the graph with its types, whether messages could be recorded or not."""
    stdout: Output
    stderr: Output
    end: ProcessEnd
    own_nodes: tuple[str, ...] = ("/turtlesim",)
    """The grader's nodes; every other node of the graph belongs to the submission."""
    interventions: tuple[str, ...] = ()
    """Services and actions of the simulator that somebody called (reset, teleport, spawn, ...), with their time."""
    doubts: tuple[str, ...] = ()
    """Why simulated time may have judged wrongly here; empty when it may be trusted."""
    lag_s: float = 0.0
    """The longest time by which the simulator was late in a wall-clock trial (s): how starved the machine was."""
