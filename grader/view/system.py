"""The ROS system for a view: the graph, the rates of topics, and the node that sends the user's commands.

The listening node is hidden and has no services, so that it does not change the visible graph. To measure the rate of a
topic, this node subscribes to the topic, but only while a page or a terminal shows rates, and only if the simulator
does not report the rate.
"""

from __future__ import annotations

import math
import threading
import time
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.qos import QoSProfile, QoSReliabilityPolicy

from grader.common.interrupts import stops_deferred
from grader.graph.endpoints import Observed, observe
from grader.graph.graph import DEBUG_TOPICS
from grader.graph.names import hidden
from grader.ros import message_values
from grader.ros.failure import Ros2Error
from grader.ros.in_order import InOrder
from grader.turtlesim.programs.teleop_keys import Cancel, Drive, Turn
from grader.view.rates import Arrivals

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from rclpy.node import Node
    from typing_extensions import Self

    from grader.turtlesim.programs.turtle_teleop_key import Teleop

LOOKED_EVERY_S = 0.4
MOST_HZ = 500.0
"""The maximum rate that is measured (Hz). Counting more messages would be too expensive."""
_SPARED_S = 10.0
_LAST_WORD_S = 1.0
"""The driving node stays in the graph for this time after `leave`, so that its last command can arrive (s)."""
DRIVER = "view_keys"
"""The name of the driving node in the graph."""

_COUNTING = QoSProfile(depth=100, reliability=QoSReliabilityPolicy.BEST_EFFORT)


@dataclass(frozen=True)
class System:
    """The graph, and the rates (Hz) of the measured topics. The rate is None if no messages arrive."""

    observed: Observed
    rates: dict[str, float | None]


class Ears:
    """A thread that spins `node`. At regular intervals, the thread passes the graph and the rates to `tell`.

    `known` returns the topics whose rates the simulator already reports. `looking` returns whether a page or a terminal
    shows the rates.
    """

    def __init__(
        self,
        node: Node,
        tell: Callable[[System], object],
        looking: Callable[[], bool],
        known: Callable[[], Collection[str]] = tuple,
    ) -> None:
        self._looking = looking
        self._node = node
        self._tell = tell
        self._known = known
        self._counters: dict[str, _Counter] = {}
        self._observed = Observed((), ())
        self._driver: tuple[str, Teleop] | None = None
        self._leave_s = math.inf
        with stops_deferred():
            self._executor = SingleThreadedExecutor()
        self._calls = InOrder(self._executor)
        self._executor.add_node(node)
        node.create_timer(LOOKED_EVERY_S, self._look)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="ros")

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._executor.wake()
        self._thread.join()
        self._leave()
        self._executor.shutdown()

    def _run(self) -> None:
        with suppress(ExternalShutdownException):
            while not self._stop.is_set():
                self._executor.spin_once(timeout_sec=1.0)

    def later(self, call: Callable[..., object], *arguments: object) -> None:
        """Call a function later in the thread of the node, after the calls that were requested before."""
        self._calls.call(call, *arguments)

    # --- the graph and the rates --------------------------------------------------------------------------------

    def _look(self) -> None:
        with suppress(UnicodeDecodeError):  # a program has a name that is not valid UTF-8: the last graph stays
            self._observed = observe(self._node)
        observed = self._observed
        now = time.monotonic()
        if now >= self._leave_s:
            self._leave()
        wanted = self._wanted(observed) if self._looking() else {}
        for topic in [topic for topic in self._counters if topic not in wanted]:
            self._counters.pop(topic).close(self._node)
        for topic, type_name in wanted.items():
            if topic not in self._counters:
                self._counters[topic] = _Counter(topic, type_name)
            self._counters[topic].look(self._node, now)
        self._tell(System(observed, {topic: counter.hertz(now) for topic, counter in self._counters.items()}))

    def _wanted(self, observed: Observed) -> dict[str, str]:
        known = self._known()
        return {
            end.topic: end.type
            for end in observed.ends
            if end.kind == "publisher"
            and not hidden(end.topic)
            and end.topic not in DEBUG_TOPICS
            and end.topic not in known
            and end.node.rpartition("/")[2] != DRIVER
        }

    # --- driving ------------------------------------------------------------------------------------------------

    def drive(self, turtle: str, key: Drive | Turn | Cancel) -> None:
        """Handle a key of turtle_teleop_key. `turtle` is the full name of the turtle, such as "/turtle1"."""
        self._leave_s = math.inf
        self._calls.call(self._drive, turtle, key)

    def leave(self) -> None:
        """Remove the driving node from the graph about a second later, so that its last command can arrive."""
        self._leave_s = time.monotonic() + _LAST_WORD_S

    async def _drive(self, turtle: str, key: Drive | Turn | Cancel) -> None:
        if self._driver is None or self._driver[0] != turtle:
            # Import this here, since it needs turtlesim, which may be missing in a view that shows only the graph.
            from grader.turtlesim.programs.turtle_teleop_key import Teleop

            self._leave()
            made = Teleop(DRIVER, turtle, tell=lambda _: None)
            self._executor.add_node(made)
            self._driver = (turtle, made)
        driver = self._driver[1]
        if isinstance(key, Drive):
            driver.drive(key)
        elif isinstance(key, Turn):
            await driver.turn(key)
        else:
            await driver.cancel()

    def _leave(self) -> None:
        if self._driver is not None:
            self._executor.remove_node(self._driver[1])
            self._driver[1].destroy_node()
            self._driver = None
            self._leave_s = math.inf


class _Counter:
    """Subscribes to one topic and counts its messages."""

    def __init__(self, topic: str, type_name: str) -> None:
        self._topic, self._type = topic, type_name
        self._arrivals = Arrivals()
        self._subscription: Any = None
        self._count = 0
        self._looked_s = time.monotonic()
        self._spared_until_s = 0.0
        try:
            self._class = message_values.load_type(type_name, "msg", "message type")
        except Ros2Error:
            # The package of the type is not sourced.
            self._class = None

    def _arrived(self, _: bytes) -> None:
        self._count += 1
        self._arrivals.add(time.monotonic())

    def look(self, node: Node, now: float) -> None:
        """Subscribe to the topic, but unsubscribe for a while if the rate is too high."""
        flood = self._count > MOST_HZ * max(now - self._looked_s, LOOKED_EVERY_S)
        self._count, self._looked_s = 0, now
        if flood:
            self.close(node)
            self._spared_until_s = now + _SPARED_S
        elif self._subscription is None and self._class is not None and now >= self._spared_until_s:
            self._arrivals = Arrivals()
            self._subscription = node.create_subscription(self._class, self._topic, self._arrived, _COUNTING, raw=True)

    def hertz(self, now: float) -> float | None:
        """Return the measured rate, MOST_HZ if the rate is too high to be measured, or None if no messages arrive."""
        return MOST_HZ if now < self._spared_until_s else self._arrivals.hertz(now)

    def close(self, node: Node) -> None:
        """Unsubscribe."""
        if self._subscription is not None:
            node.destroy_subscription(self._subscription)
            self._subscription = None
