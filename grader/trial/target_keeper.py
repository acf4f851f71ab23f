"""The node `spawner`, which a trial adds for the game of catching turtles: it announces and removes targets.

The node of the trial receives the names on /targets twice a second, and calls /catch to have a turtle removed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rclpy.node import Node
from std_msgs.msg import String
from turtlesim.srv import Kill

from grader.turtlesim.turtle import Start

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.trial.inputs import Inputs
    from grader.turtlesim.node import TurtlesimNode

NAME = "spawner"
TOPIC = "/targets"
SERVICE = "/catch"
ANNOUNCED_EVERY_S = 0.5
NEAR_M = 1.0
LATE_S = 1.5
"""A late service is offered this time (s) after turtle1 first came within NEAR_M (m) of a target, or when turtle1 has
stood still for this time. It is never offered before `catch_from_s` of the inputs. Within LATE_S, every node that is
fast enough to catch all targets comes close enough to the target to call the service. A node may also wait for the
service before it drives.
"""


class TargetKeeper(Node):
    """Adds the targets, announces the remaining targets, and removes each target that a node caught.

    After the first catch, it also withdraws one of `inputs.withdrawn`, as if another node had caught it.
    """

    def __init__(
        self,
        turtlesim: TurtlesimNode,
        inputs: Inputs,
        on_call: Callable[[str, str, Any, Any, float], object],
    ) -> None:
        """Create the node. `on_call` is called for each service call, as in `grader.turtlesim.interface.Hooks`."""
        super().__init__(NAME)
        self._turtlesim = turtlesim
        self._inputs = inputs
        self._on_call = on_call
        self._publisher = self.create_publisher(String, TOPIC, 10)
        self._left = [target.name for target in inputs.targets]
        self._next_s = 0.0
        self._near_s: float | None = None
        self._rest, self._rest_s = self._place(), 0.0
        self.withdrawn: tuple[str, ...] = ()
        self.catch_from_s: float | None = None
        """The time from which the service exists (s), or None if it does not exist yet."""
        for target in inputs.targets:
            turtlesim.add_turtle(target.name, Start(target.x, target.y, 0.0))
        if not inputs.catch_from_s:
            self._offer(0.0)

    def frame(self, now_s: float) -> None:
        """Announce the remaining targets if an announcement is due at this time (s), and offer the service if due."""
        if self.catch_from_s is None and self._is_due(now_s):
            self._offer(now_s)
        if now_s >= self._next_s:
            self._next_s = now_s + ANNOUNCED_EVERY_S
            self._publisher.publish(String(data=" ".join(self._left)))

    def _offer(self, now_s: float) -> None:
        self.catch_from_s = now_s
        self.create_service(Kill, SERVICE, self._caught)

    def _is_due(self, now_s: float) -> bool:
        """Return whether a late service must be offered at the time `now_s` (s)."""
        place = self._place()
        if place != self._rest:
            self._rest, self._rest_s = place, now_s
        if self._near_s is None and any(math.dist(place, (each.x, each.y)) < NEAR_M for each in self._inputs.targets):
            self._near_s = now_s
        since_s = self._rest_s if self._near_s is None else min(self._rest_s, self._near_s)
        return now_s >= max(self._inputs.catch_from_s, since_s + LATE_S)

    def _place(self) -> tuple[float, float]:
        state = self._turtlesim.turtle_state("turtle1")
        return (math.inf, math.inf) if state is None else (state.x, state.y)

    def _caught(self, request: Kill.Request, response: Kill.Response) -> Kill.Response:
        if request.name in self._left:
            self._remove(request.name)
            if not self.withdrawn:
                self.withdrawn = tuple(name for name in self._inputs.withdrawn if name in self._left)[:1]
                for name in self.withdrawn:
                    self._remove(name)
        else:
            self.get_logger().warning(f"There is no target named [{request.name}]")
        self._on_call(SERVICE, "turtlesim/srv/Kill", request, response, 0.0)
        return response

    def _remove(self, name: str) -> None:
        self._left.remove(name)
        self._turtlesim.remove_turtle(name)
