"""The node `spawner`, which a trial adds for the game of catching turtles: it announces and removes targets.

The node of the trial receives the names on /targets twice a second, and calls /catch to have a turtle removed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.node import Node
from std_msgs.msg import String
from turtlesim.srv import Kill

from grader.turtlesim.turtle import Start

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.trial.target_places import Target
    from grader.turtlesim.node import TurtlesimNode

NAME = "spawner"
TOPIC = "/targets"
SERVICE = "/catch"
ANNOUNCED_EVERY_S = 0.5


class TargetKeeper(Node):
    """Adds the targets, announces the remaining targets, and removes each target that a node caught."""

    def __init__(
        self,
        turtlesim: TurtlesimNode,
        targets: tuple[Target, ...],
        on_call: Callable[[str, str, Any, Any, float], object],
    ) -> None:
        """Create the node. `on_call` is called for each service call, as in `grader.turtlesim.interface.Hooks`."""
        super().__init__(NAME)
        self._turtlesim = turtlesim
        self._on_call = on_call
        self._publisher = self.create_publisher(String, TOPIC, 10)
        self.create_service(Kill, SERVICE, self._caught)
        self._left = [target.name for target in targets]
        self._next_s = 0.0
        for target in targets:
            turtlesim.add_turtle(target.name, Start(target.x, target.y, 0.0))

    def frame(self, now_s: float) -> None:
        """Announce the remaining targets if an announcement is due at this time (s)."""
        if now_s >= self._next_s:
            self._next_s = now_s + ANNOUNCED_EVERY_S
            self._publisher.publish(String(data=" ".join(self._left)))

    def _caught(self, request: Kill.Request, response: Kill.Response) -> Kill.Response:
        if request.name in self._left:
            self._left.remove(request.name)
            self._turtlesim.remove_turtle(request.name)
        else:
            self.get_logger().warning(f"There is no target named [{request.name}]")
        self._on_call(SERVICE, "turtlesim/srv/Kill", request, response, 0.0)
        return response
