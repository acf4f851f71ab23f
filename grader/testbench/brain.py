"""The brain of a node under test: the code that decides how the node reacts to each event.

This code runs in the grader, never in the sandbox cell. The node in the cell is the same in every run
(relayed_node.py), and requests each command from this code. Therefore, tests can tell a correct node from a broken node
only by its behaviour.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.exercise.node_under_test import FIELDS, SIDE_M
from grader.testbench.result import LATEST_S, NodeEvents

if TYPE_CHECKING:
    from grader.exercise.node_under_test import Behaviour

MOST_NODES = 1000
"""The maximum number of nodes in one run. A normal test creates one or two nodes."""

Values = list[float]
"""The six values of a command, in the order of FIELDS."""


@dataclass
class _State:
    """The state of one node: the last pose (m) and its arrival time (ns), whether the node is turning, and counters.

    `first_ns` and `clock_ns` are the times of the first and the last event on the node's clock (ns).
    """

    x: float = 0.0
    y: float = 0.0
    received_ns: int | None = None
    turns: bool = False
    poses: int = 0
    calls: int = 0
    commands: int = 0
    first_ns: int | None = None
    clock_ns: int | None = None

    def happens(self, now_ns: int) -> None:
        """Record that an event occurred at this time of the node's clock (ns)."""
        self.first_ns = now_ns if self.first_ns is None else self.first_ns
        self.clock_ns = now_ns


class Brain:
    """Controls the nodes that are created in one run of the tests. All of them get the name `node`.

    After MOST_NODES nodes, each further node shares its state with the last of them.
    """

    def __init__(self, behaviour: Behaviour, node: str) -> None:
        self._behaviour = behaviour
        self._node = node
        self._states: list[_State] = []

    def create(self) -> dict[str, Any]:
        """Add a node, and return its name, its number, its topics, its message type and its timer period."""
        if len(self._states) < MOST_NODES:
            self._states.append(_State())
        of = self._behaviour
        return {
            "node": self._node,
            "number": len(self._states) - 1,
            "topic": of.topic,
            "type": of.type,
            "listens": of.listens,
            "period_s": of.period_s,
        }

    def pose(self, number: int, now_ns: int, x: float, y: float) -> None:
        """Store the pose (m) that node `number` received at this time of its clock (ns)."""
        if number < len(self._states):
            state = self._states[number]
            state.x, state.y, state.received_ns = x, y, now_ns
            state.poses += 1
            state.happens(now_ns)

    def tick(self, number: int, now_ns: int) -> Values | None:
        """Return the command that node `number` publishes when its timer fires at this time (ns), or None."""
        if number >= len(self._states):
            return None
        state = self._states[number]
        command = self._react(state, now_ns)
        state.calls += 1
        state.commands += command is not None
        state.happens(now_ns)
        return command

    def events(self) -> NodeEvents | None:
        """Return what happened to the node that was created last, or None if there is no node."""
        if not self._states:
            return None
        of, calls = self._states[-1], sum(state.calls for state in self._states)
        return NodeEvents(of.poses, of.calls, of.commands, _seconds(of.first_ns), _seconds(of.clock_ns), calls)

    def _react(self, state: _State, now_ns: int) -> Values | None:
        of = self._behaviour
        if not of.publishes:
            return None
        if state.received_ns is None:
            return None if of.waits else self._command(of.speed_m_s, 0.0)
        if of.timeout_s and now_ns - state.received_ns > of.timeout_s * 1e9:
            return self._command(0.0, 0.0)
        if self._near(state):
            state.turns = True
            return self._command(of.slow_m_s, of.turn_rad_s)
        if state.turns and not of.straightens:
            return self._command(of.slow_m_s, of.turn_rad_s)
        state.turns = False
        return self._command(of.speed_m_s, 0.0)

    def _near(self, state: _State) -> bool:
        distances = {"left": state.x, "right": SIDE_M - state.x, "bottom": state.y, "top": SIDE_M - state.y}
        return any(distances[wall] < self._behaviour.margin_m for wall in self._behaviour.walls)

    def _command(self, speed_m_s: float, turn_rad_s: float) -> Values:
        values = dict.fromkeys(FIELDS, 0.0)
        values[self._behaviour.speed_field] = speed_m_s
        values[self._behaviour.turn_field] = turn_rad_s if self._behaviour.turns_left else -turn_rad_s
        return list(values.values())


def _seconds(time_ns: int | None) -> float | None:
    return None if time_ns is None else min(max(time_ns / 1e9, 0.0), LATEST_S)
