"""Recording: everything that was observed in a trial, in memory."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

from grader.common.lazy import np

if TYPE_CHECKING:
    from collections.abc import Iterable

    import numpy.typing as npt

    from grader.trial.observed import Call, Goal, Offer, PenChange, Track

    Floats = npt.NDArray[np.float64]

AFTER_STALL_S = 0.05
"""The time after a stall during which messages may still arrive late (s)."""
OUTLIVES_S = 0.2
"""The trajectory goes on for this long after the node has exited on its own (s). Thus, a last command always moves the
turtle, and it does not matter how soon the grader notices the exit."""

ClockName = Literal["simulated", "wall"]


@dataclass(frozen=True)
class Pose:
    """The pose of a turtle: x and y in m from the lower left corner, theta in rad, counter-clockwise from east."""

    x: float
    y: float
    theta: float


@dataclass(frozen=True)
class Message:
    """A message that was received.

    `data` is the message as serialized in CDR. `t_s` is the arrival time on the trial's clock (s, 0 until the
    scenario starts). `mono_s` is the arrival time on CLOCK_MONOTONIC (s).
    """

    topic: str
    type: str
    data: bytes
    t_s: float
    mono_s: float


FIELDS = ("linear.x", "linear.y", "linear.z", "angular.x", "angular.y", "angular.z")
"""The fields of a command: three in m/s, three in rad/s."""


@dataclass(frozen=True)
class Command:
    """A geometry_msgs/msg/Twist that the turtle received on /turtle1/cmd_vel: `linear` in m/s, `angular` in rad/s."""

    t_s: float
    mono_s: float
    linear: tuple[float, float, float]
    angular: tuple[float, float, float]

    @property
    def values(self) -> tuple[float, ...]:
        """The six values in the order of FIELDS."""
        return (*self.linear, *self.angular)


@dataclass(frozen=True)
class LogLine:
    """A message on /rosout, with its arrival time. `level` is DEBUG, INFO, WARN, ERROR, FATAL or a number."""

    t_s: float
    level: str
    logger: str
    text: str


@dataclass(frozen=True)
class Endpoint:
    """A publisher or subscription in the ROS graph. `node` is the full name of the node, such as "/draw_circle"."""

    kind: Literal["publisher", "subscription"]
    node: str
    topic: str
    type: str


@dataclass(frozen=True)
class Graph:
    """The ROS graph at the time `t_s` of the trial's clock, with /turtlesim but without the grader's hidden nodes."""

    t_s: float
    nodes: tuple[str, ...]
    endpoints: tuple[Endpoint, ...]


@dataclass(frozen=True)
class Frames:
    """The state of turtle1 in the simulator, one row per frame (16 ms), as arrays of shape (N,).

    `t_s` is in s, `x` and `y` in m, `theta` in rad, `linear` in m/s and `angular` in rad/s. `wall` is true if a wall
    limited the position.
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
    """The text of one output stream, in which invalid bytes have been replaced.

    `dropped` is the number of bytes that exceeded the limit and were not kept.

    `times` are the arrival times of the lines of `text` on the trial's clock (s), one per line.
    """

    text: str
    dropped: int = 0
    times: tuple[float, ...] = ()


@dataclass(frozen=True)
class ProcessEnd:
    """The end of the node's process.

    `by` is "itself" if the process ended before the scenario was over, on its own or because of `out_of`. Otherwise,
    `by` is the last signal that the grader sent to end the scenario. `out_of` is set if the grader or the kernel
    stopped the process because it used more "memory", "processes" or "files" than a node may use. `stop_s` is the time
    from SIGINT to the exit of the process (s of wall time, without the time for which it waited for a processor), or
    None if `by` is "itself". If the process exited while another node was being stopped, `by` is "SIGINT" and `stop_s`
    is 0. `t_s` is the time of SIGINT or, if `by` is "itself", the time of the exit (s on the trial's clock).
    `exit_code` is negative for a signal, as in subprocess.
    """

    by: Literal["itself", "SIGINT", "SIGTERM", "SIGKILL"]
    exit_code: int
    t_s: float
    stop_s: float | None
    out_of: str | None = None


@dataclass(frozen=True)
class Beside:
    """The part of a recording about an additional node, which ran next to the node of the trial."""

    executable: str
    stdout: Output
    stderr: Output
    end: ProcessEnd


@dataclass(frozen=True)
class Recording:
    """Everything that was observed in one trial. `why` explains to a beginner why this clock was used."""

    clock: ClockName
    why: str
    seed: int | None
    start: Pose
    duration_s: float
    sigint_t_s: float
    messages: tuple[Message, ...]
    dropped: int
    """The number of messages that were not kept because there were too many."""
    commands: tuple[Command, ...]
    frames: Frames
    log: tuple[LogLine, ...]
    graphs: tuple[Graph, ...]
    topics: dict[str, tuple[str, ...]]
    """The topics of the graph with their types, up to a limit, including topics whose messages could not be
    recorded."""
    stdout: Output
    stderr: Output
    end: ProcessEnd
    beside: tuple[Beside, ...] = ()
    """The other nodes of the submission in the same trial."""
    own_nodes: tuple[str, ...] = ("/turtlesim",)
    """The full names of the grader's nodes, such as /turtlesim and /spawner. Every other node in the graph counts as a
    node of the submission."""
    interventions: tuple[str, ...] = ()
    """The calls to services and actions of the simulator by name, in order, such as "spawn" or "teleport_absolute".
    After a maximum number of calls, only names that are not in the tuple yet are added."""
    interventions_dropped: int = 0
    """The number of calls that were not kept because there were too many."""
    calls: tuple[Call, ...] = ()
    """The service calls, in order: from nodes to the grader's nodes and to each other, and from the trial to the node.
    Their number is limited."""
    goals: tuple[Goal, ...] = ()
    """The goals that nodes sent to the actions of the simulator, in order, up to a limit."""
    offers: tuple[Offer, ...] = ()
    """The services of the submission's nodes. They are recorded only if the trial calls services or has several
    nodes."""
    pens: tuple[PenChange, ...] = ()
    """The changes to the pens, in order, up to a limit. A new turtle has turtlesim's default pen."""
    tracks: tuple[Track, ...] = ()
    """The tracks of the turtles other than turtle1. Their length is limited, except for targets."""
    withdrawn: tuple[str, ...] = ()
    """The targets that the trial itself removed, although no node had caught them."""
    catch_from_s: float | None = None
    """The time from which the trial's own service /catch existed (s), or None if it never existed."""
    graph_dropped: int = 0
    """The number of topics, nodes, endpoints and snapshots of the graph that were not kept because there were too
    many."""
    doubts: tuple[str, ...] = ()
    """The reasons why simulated time may misjudge this node. In a trial in wall time, the tuple is empty."""
    seconds: dict[str, float] = field(default_factory=dict)
    """The wall time of each part of the trial: start, discovery, run, stop (s)."""
    stalls: tuple[tuple[float, float], ...] = ()
    """The periods in which the machine made the simulator or the node wait for a processor: (from, to) on the trial's
    clock (s), only in wall time. If the system's clock was set, the whole trial is such a period."""
    crowded: bool = False
    """Whether, in a trial in wall time, other programs used the processors so much that the simulator and the node
    often had to wait."""

    def seen_from(self, executable: str) -> Recording:
        """Return a copy of the recording with the output and the end of an additional node.

        Raises KeyError if no additional node ran this executable.
        """
        other = {each.executable: each for each in self.beside}[executable]
        return replace(self, stdout=other.stdout, stderr=other.stderr, end=other.end)

    @property
    def stalled_s(self) -> float:
        """The total length of all stalls (s)."""
        return sum(end - begin for begin, end in self.stalls)

    def stalled(self, t_s: float) -> bool:
        """Return whether this time was during a stall or right after a stall.

        At such times, the arrival time of a message depends more on the machine than on the node.
        """
        return any(begin <= t_s <= end + AFTER_STALL_S for begin, end in self.stalls)


def frames_of(rows: Iterable[tuple[float, float, float, float, float, float, bool]]) -> Frames:
    """Return Frames with these rows (t_s, x, y, theta, linear, angular, wall)."""
    table = np.array([tuple(map(float, row)) for row in rows], dtype=np.float64).reshape(-1, 7)
    t_s, x, y, theta, linear, angular, wall = table.T
    return Frames(t_s, x, y, theta, linear, angular, wall.astype(np.bool_))
