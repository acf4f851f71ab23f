"""The action rotate_absolute of one turtle. It accepts goals, sends feedback in each frame, and sends a result."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rclpy.action import ActionServer, CancelResponse
from turtlesim.action import RotateAbsolute

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.action.server import ServerGoalHandle
    from rclpy.node import Node

    from grader.turtlesim.turtle import Rotation, Turtle


class _DeferringActionServer(ActionServer):
    """An action server whose goals are executed by the turtle's frames instead of a callback.

    rclpy would run a callback from the acceptance of a goal to its result. This callback would have to wait, and it
    would keep an executor busy. Therefore, a goal is only marked as executing, and the callback runs when there is a
    result.
    """

    def notify_execute(
        self,
        goal_handle: ServerGoalHandle,
        execute_callback: Callable[[ServerGoalHandle], RotateAbsolute.Result] | None,
    ) -> None:
        """Do nothing, because the frames execute the goal."""

    def give_result(self, goal_handle: ServerGoalHandle, result: RotateAbsolute.Result) -> None:
        """Send the result of a finished goal to the clients that request it."""
        super().notify_execute(goal_handle, lambda _: result)


class RotateAbsoluteServer:
    """Connects the goals of a turtle's action with its rotations."""

    def __init__(
        self, node: Node, name: str, find_turtle: Callable[[], Turtle | None], on_goal: Callable[[], object]
    ) -> None:
        """Create the server. `find_turtle` returns the turtle, or None if it was killed. `on_goal` runs per goal."""
        self._log = node.get_logger()
        self._find_turtle = find_turtle
        self._on_goal = on_goal
        self._goals: list[tuple[Rotation, ServerGoalHandle]] = []
        self._feedback = RotateAbsolute.Feedback()
        self._server = _DeferringActionServer(
            node,
            RotateAbsolute,
            f"{name}/rotate_absolute",
            execute_callback=lambda _: RotateAbsolute.Result(),
            handle_accepted_callback=self._accept,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )

    def _accept(self, goal: ServerGoalHandle) -> None:
        self._on_goal()
        goal.execute()
        turtle = self._find_turtle()
        if turtle is None:
            goal.abort()
            self._server.give_result(goal, RotateAbsolute.Result())
            return
        if turtle.rotation is not None:
            self._log.warning("Rotation goal received before a previous goal finished. Aborting previous goal")
        self._goals.append((turtle.rotate_to(goal.request.theta), goal))

    def before_frame(self) -> None:
        """Pass cancel requests on to the turtle."""
        for rotation, goal in self._goals:
            rotation.cancel = goal.is_cancel_requested

    def after_frame(self) -> None:
        """Send feedback and results to the clients."""
        ended = False
        for rotation, goal in self._goals:
            if rotation.end in (None, "succeeded"):
                self._feedback.remaining = rotation.remaining
                goal.publish_feedback(self._feedback)
            if rotation.end is not None:
                ended = True
                self._end(rotation, goal)
        if ended:
            self._goals = [(rotation, goal) for rotation, goal in self._goals if rotation.end is None]

    def _end(self, rotation: Rotation, goal: ServerGoalHandle) -> None:
        if rotation.end == "succeeded":
            self._log.info("Rotation goal completed successfully")
            goal.succeed()
        elif rotation.end == "canceled":
            self._log.info("Rotation goal canceled")
            goal.canceled()
        else:
            goal.abort()
        self._server.give_result(goal, RotateAbsolute.Result(delta=rotation.delta))

    @property
    def idle(self) -> bool:
        """Return whether there is no current goal."""
        return not self._goals

    def destroy(self) -> None:
        """Remove the action from the graph."""
        self._server.destroy()
