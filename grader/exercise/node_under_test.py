"""A node under test: what the student's tests must accept (the right node) or reject (each broken node).

The node reads the turtle's pose, and publishes velocity commands that keep the turtle away from the walls. A broken
node differs from the right one in at least one field.
"""

from __future__ import annotations

from dataclasses import dataclass, field

WALLS = ("left", "right", "bottom", "top")
MESSAGES = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
FIELDS = ("linear.x", "linear.y", "linear.z", "angular.x", "angular.y", "angular.z")
SIDE_M = 11.0
"""The walls are at 0 and at SIDE_M (m), in x and in y."""


@dataclass(frozen=True, kw_only=True)
class Behaviour:
    """The behaviour of a node. The defaults are those of the right node."""

    topic: str = "/turtle1/cmd_vel"
    type: str = MESSAGES[0]
    listens: str = "/turtle1/pose"
    period_s: float = 0.1
    speed_m_s: float = 1.0
    """The speed away from the walls."""
    slow_m_s: float = 0.5
    """The speed near a wall."""
    turn_rad_s: float = 1.5
    """How fast it turns near a wall; a positive number is to the left."""
    speed_field: str = "linear.x"
    turn_field: str = "angular.z"
    margin_m: float = 1.0
    """How close to a wall it starts to turn."""
    timeout_s: float = 1.0
    """It stops when the last pose is older than this; 0 if it never stops."""
    walls: tuple[str, ...] = WALLS
    """The walls that it turns away from."""
    publishes: bool = True
    waits: bool = True
    """Whether it publishes nothing before the first pose."""
    straightens: bool = True
    """Whether it drives straight on again when it is away from the wall."""


@dataclass(frozen=True)
class NodeUnderTest:
    """A broken node, with its id."""

    id: str
    behaviour: Behaviour


@dataclass(frozen=True)
class TestsSpec:
    """The table `[trial.tests]`: the tests of the student run on the right node and on every broken node.

    `module` and `name` are the class of the node that the tests import. `right_runs` is how often the tests run on
    the right node. `duration_s` (s) is the longest time of one run.
    """

    __test__ = False  # pytest must not take this class for a test

    module: str
    name: str
    right_runs: int
    duration_s: float
    right: Behaviour
    broken: tuple[NodeUnderTest, ...] = field(default=())
