"""A node under test, which the student's tests must accept (the correct node) or reject (a broken node).

The node reads the turtle's pose, and publishes velocity commands that keep the turtle away from the walls. A broken
node differs from the correct node in at least one field.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.exercise.own_numbers import Value

WALLS = ("left", "right", "bottom", "top")
MESSAGES = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
FIELDS = ("linear.x", "linear.y", "linear.z", "angular.x", "angular.y", "angular.z")
SIDE_M = 11.0
"""The walls are at 0 and at SIDE_M (m), in x and in y."""


@dataclass(frozen=True, kw_only=True)
class Behaviour:
    """The behaviour of a node.

    The correct node has the defaults, except for the keys of `[trial.tests.right]` and the student's own numbers.
    """

    topic: str = "/turtle1/cmd_vel"
    type: str = MESSAGES[0]
    listens: str = "/turtle1/pose"
    period_s: float = 0.1
    speed_m_s: float = 1.0
    """The speed when no wall is near."""
    slow_m_s: float = 0.5
    """The speed near a wall."""
    turn_rad_s: float = 1.5
    """The angular speed near a wall. A positive value turns left."""
    turns_left: bool = True
    """Whether the sign of `turn_rad_s` is kept. If not, the node turns in the other direction."""
    speed_field: str = "linear.x"
    turn_field: str = "angular.z"
    margin_m: float = 1.0
    """The distance from a wall at which the node starts to turn."""
    timeout_s: float = 1.0
    """The maximum age of the last pose.

    The node stops if the last pose is older than this. With 0, the node never stops.
    """
    walls: tuple[str, ...] = WALLS
    """The walls that the node avoids."""
    publishes: bool = True
    waits: bool = True
    """Whether the node publishes nothing before the first pose."""
    straightens: bool = True
    """Whether the node drives straight ahead again when it is no longer near a wall."""


@dataclass(frozen=True)
class NodeUnderTest:
    """A broken node, with its id."""

    id: str
    behaviour: Behaviour


@dataclass(frozen=True)
class TestsSpec:
    """The table `[trial.tests]`: the student's tests run on the correct node and on every broken node.

    The tests import the class `name` from `module`. The tests run `right_runs` times on the correct node. `duration_s`
    (s) is the maximum duration of one run. `own` contains names of attributes of `right`. Each of these attributes gets
    the student's own number of the same name.
    """

    __test__ = False  # keeps pytest from collecting this class

    module: str
    name: str
    right_runs: int
    duration_s: float
    right: Behaviour
    broken: tuple[NodeUnderTest, ...] = field(default=())
    own: tuple[str, ...] = ()

    def with_numbers(self, numbers: Mapping[str, Value]) -> TestsSpec:
        """Return a copy with the student's own numbers.

        In a broken node, the values that differ from those of the correct node stay unchanged.
        """
        drawn = {name: float(numbers[name]) for name in self.own}

        def with_drawn(behaviour: Behaviour) -> Behaviour:
            kept = {name: value for name, value in drawn.items() if _same(behaviour, self.right, name)}
            return replace(behaviour, **kept)  # type: ignore[arg-type]

        broken = tuple(NodeUnderTest(each.id, with_drawn(each.behaviour)) for each in self.broken)
        return replace(self, right=with_drawn(self.right), broken=broken)


def _same(behaviour: Behaviour, right: Behaviour, name: str) -> bool:
    return bool(getattr(behaviour, name) == getattr(right, name))
