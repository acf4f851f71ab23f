"""The node `turtlesim`: a headless turtlesim for ROS 2.

The owner of the node spins the node, and calls `frame` once per frame with the time of the owner's clock. The owner is
a trial or, in wall time, standalone.py. The node uses no timer and no ROS clock.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any

from rcl_interfaces.msg import ParameterEvent, SetParametersResult
from rclpy.node import Node
from rclpy.qos import qos_profile_parameter_events
from std_srvs.srv import Empty
from turtlesim.srv import Kill, Spawn

from grader.common.words import shorten
from grader.turtlesim import parameters
from grader.turtlesim.interface import Hooks, TurtleInterface
from grader.turtlesim.late_answers import LateAnswers
from grader.turtlesim.turtle import Start
from grader.turtlesim.world import World

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from rclpy.parameter import Parameter

    from grader.turtlesim.canvas import Canvas
    from grader.turtlesim.goal_event import GoalEvent
    from grader.turtlesim.turtle import State

MOST_TURTLES = 64
"""The maximum number of turtles. The real turtlesim has no limit, but ours must not crash if spawning never stops."""
MOST_NAME = 300
"""The maximum length of a name in a log message. A longer name is shortened. Any node can send any name, even one with
terminal control sequences."""

_FRAMES_TO_LEAVE = 4
"""The minimum number of frames for which the entities of a killed turtle are kept, so that earlier requests get
responses."""


def _nobody(*_: object) -> None:
    """Do nothing, as the default callback."""


class TurtlesimNode(Node):
    """A node with the topics, services, actions and parameters of turtlesim. Its turtles are in a `World`."""

    def __init__(
        self,
        *,
        start: Start | None = None,
        on_command: Callable[[str, bytes, Any], object] = _nobody,
        on_publish: Callable[[str, str, bytes], object] = _nobody,
        on_intervention: Callable[[str], object] = _nobody,
        on_call: Callable[[str, str, Any, Any, float], object] = _nobody,
        on_goal: Callable[[GoalEvent], object] = _nobody,
        pose_every: int = 1,
        pose_from_s: float = 0.0,
        answers_after_s: float = 0.0,
        canvas: Canvas | None = None,
        **node: Any,  # noqa: ANN401 - handed on to rclpy
    ) -> None:
        """Create the node. turtle1 starts at `start` (m, m, rad), also after a reset.

        `Hooks` describes the callbacks. Pose and colour are published every `pose_every` frames, but the pose of
        turtle1 is not published before `pose_from_s` (s). The real turtlesim publishes both in each frame. Services
        execute each call and respond to it `answers_after_s` (s) after it arrived. The turtles draw on `canvas`.
        """
        self._pose_every, self._pose_from_s = pose_every, pose_from_s
        self._late = LateAnswers(answers_after_s) if answers_after_s else None
        self._hooks = Hooks(on_command, on_publish, on_intervention, on_call, on_goal, self._late)
        super().__init__("turtlesim", **node)
        parameters.declare(self)
        self.world = World(start or Start(), canvas)
        self._take_parameters(self._parameters_of_ours())
        self.add_post_set_parameters_callback(self._parameters_set)
        # The real turtlesim subscribes to parameter events to repaint its window. This node has no window, but it
        # should look the same in the graph.
        for _ in ("turtlesim", "the clock that rclcpp gives every node"):
            self.create_subscription(
                ParameterEvent, "/parameter_events", lambda _: None, qos_profile_parameter_events, raw=True
            )
        self._hooks.serve(self, Empty, "clear", self._clear)
        self._hooks.serve(self, Empty, "reset", self._reset)
        self._hooks.serve(self, Spawn, "spawn", self._spawn)
        self._hooks.serve(self, Kill, "kill", self._kill)
        self._interfaces: dict[str, TurtleInterface] = {}
        self._leaving: deque[tuple[int, TurtleInterface]] = deque()
        self._frames = 0
        self.get_logger().info(f"Starting turtlesim with node name {self.get_fully_qualified_name()}")
        self._show("turtle1")
        self._log_spawned("turtle1")

    def frame(self, now_s: float) -> None:
        """Compute one frame (16 ms) at `now_s` on the caller's clock (s), and send the messages that are due."""
        self._frames += 1
        if self._late is not None:
            self._late.tick(now_s)
        while self._leaving and self._leaving[0][0] <= self._frames and self._leaving[0][1].idle:
            self._leaving.popleft()[1].destroy()
        interfaces = [*self._interfaces.values(), *(interface for _, interface in self._leaving)]
        for interface in interfaces:
            interface.before_frame()
        self.world.step(now_s)
        for interface in interfaces:
            interface.after_frame(now_s)

    def turtle_state(self, name: str = "turtle1") -> State | None:
        """Return the state of a turtle after the last frame, or None if no turtle has that name."""
        turtle = self.world.turtles.get(name)
        return turtle.state() if turtle is not None else None

    def save_image(self, path: Path) -> None:
        """Write the canvas with the trails to a PNG file."""
        self.world.canvas.save(path)

    # --- turtles ----------------------------------------------------------------------------------------------

    def _show(self, name: str) -> None:
        """Create the topics, services and action of a turtle.

        If those of a killed turtle of the same name still exist, use them again.
        """
        for waiting in self._leaving:
            if waiting[1].name == name:
                self._leaving.remove(waiting)
                self._interfaces[name] = waiting[1]
                return
        from_s = self._pose_from_s if name == "turtle1" else 0.0
        self._interfaces[name] = TurtleInterface(self, name, self.world, self._hooks, self._pose_every, from_s)

    def _hide(self, name: str) -> None:
        # Remove the entities later, since this runs in a callback, and the executor may still call others of this
        # turtle.
        self._leaving.append((self._frames + _FRAMES_TO_LEAVE, self._interfaces.pop(name)))

    def _log_spawned(self, name: str) -> None:
        turtle = self.world.turtles[name]
        self.get_logger().info(
            f"Spawning turtle [{name}] at x=[{turtle.x:f}], y=[{turtle.y:f}], theta=[{turtle.theta:f}]"
        )

    def _spawn(self, request: Spawn.Request, response: Spawn.Response) -> Spawn.Response:
        self._hooks.on_intervention("spawn")
        if len(self.world.turtles) >= MOST_TURTLES:
            self.get_logger().error(f"There are {MOST_TURTLES} turtles already; no more can be spawned")
            return response
        response.name = self.add_turtle(request.name, Start(request.x, request.y, request.theta))
        return response

    def add_turtle(self, wanted: str, start: Start) -> str:
        """Add a turtle at `start`. Return the turtle's name, or "" after logging an error."""
        name = self.world.spawn(wanted, start)
        if not name:
            self.get_logger().error(f"A turtle named [{shorten(wanted, MOST_NAME)}] already exists")
            return ""
        try:
            self._show(name)
        except Exception as error:
            # The real turtlesim exits with this exception. The first line of the message gives the reason.
            self.world.kill(name)
            why = str(error).partition("\n")[0]
            self.get_logger().error(f"A turtle cannot be named [{shorten(name, MOST_NAME)}]: {why}")
            return ""
        self._log_spawned(name)
        return name

    def _kill(self, request: Kill.Request, response: Kill.Response) -> Kill.Response:
        self._hooks.on_intervention("kill")
        self.remove_turtle(request.name)
        return response

    def remove_turtle(self, name: str) -> None:
        """Remove a turtle. Log an error if no turtle has this name."""
        if self.world.kill(name):
            self._hide(name)
        else:
            self.get_logger().error(f"Tried to kill turtle [{shorten(name, MOST_NAME)}], which does not exist")

    def _clear(self, _: Empty.Request, response: Empty.Response) -> Empty.Response:
        self._hooks.on_intervention("clear")
        self.clear()
        return response

    def clear(self) -> None:
        """Clear the trail."""
        self.get_logger().info("Clearing turtlesim.")
        self.world.canvas.clear()

    def _reset(self, _: Empty.Request, response: Empty.Response) -> Empty.Response:
        self._hooks.on_intervention("reset")
        self.reset()
        return response

    def reset(self) -> None:
        """Reset the simulator: remove the trail and all turtles, and put turtle1 at its start."""
        self.get_logger().info("Resetting turtlesim.")
        self.world.reset()
        for name in [name for name in self._interfaces if name != "turtle1"]:
            self._hide(name)
        if "turtle1" not in self._interfaces:
            self._show("turtle1")
        self._log_spawned("turtle1")

    # --- parameters -------------------------------------------------------------------------------------------

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set parameters as rclpy does, but reject invalid values with the real turtlesim's messages."""
        return parameters.refusal(self, parameter_list) or super().set_parameters_atomically(parameter_list)

    def _parameters_of_ours(self) -> list[Parameter]:
        ours: list[Parameter] = self.get_parameters([*parameters.CHANNELS, parameters.HOLONOMIC])
        return ours

    def _parameters_set(self, changed: Iterable[Parameter]) -> None:
        given = list(changed)
        colours = all(parameter.name in parameters.CHANNELS for parameter in given)
        self._hooks.on_intervention("set_background" if colours else "set_parameters")
        self._take_parameters(given)

    def _take_parameters(self, changed: Iterable[Parameter]) -> None:
        background = list(self.world.canvas.background)
        for parameter in changed:
            if parameter.name == parameters.HOLONOMIC:
                self.world.holonomic = parameter.value
            elif parameter.name in parameters.CHANNELS:
                background[parameters.CHANNELS.index(parameter.name)] = parameter.value
        red, green, blue = background
        self.world.canvas.background = (red, green, blue)
