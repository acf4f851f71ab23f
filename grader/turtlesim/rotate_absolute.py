"""The action rotate_absolute of one turtle. The server accepts goals, and sends feedback and results."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.action import ActionServer, CancelResponse
from turtlesim.action import RotateAbsolute

from grader.turtlesim.goal_event import TYPE, GoalEvent

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.action.server import ServerGoalHandle
    from rclpy.node import Node

    from grader.turtlesim.goal_event import What
    from grader.turtlesim.turtle import Rotation, Turtle


class _DeferringActionServer(ActionServer):
    """An action server whose goals are executed frame by frame instead of in a callback.

    In rclpy, one callback runs from the acceptance of a goal to its result. A callback that waits for the end of a goal
    would block an executor. Therefore, a goal is only marked as executing, and the callback runs when the result is
    known.
    """

    def __init__(self, *args: Any, on_result_request: Callable[[bytes], object], **kwargs: Any) -> None:  # noqa: ANN401
        """Create the server. `on_result_request` is called with the goal's id when a client requests the result."""
        self._on_result_request = on_result_request
        super().__init__(*args, **kwargs)

    async def execute(self, taken_data: dict[str, Any]) -> None:
        """Handle the requests that have arrived."""
        if "result" in taken_data:
            _, request = taken_data["result"]
            self._on_result_request(bytes(request.goal_id.uuid))
        await super().execute(taken_data)

    def notify_execute(
        self,
        goal_handle: ServerGoalHandle,
        execute_callback: Callable[[ServerGoalHandle], RotateAbsolute.Result] | None,
    ) -> None:
        """Do nothing, because the simulator executes the goal, one step per frame."""

    def give_result(self, goal_handle: ServerGoalHandle, result: RotateAbsolute.Result) -> None:
        """Send the result of a finished goal to the clients that request it."""
        super().notify_execute(goal_handle, lambda _: result)


class RotateAbsoluteServer:
    """Connects the goals of a turtle's action with the rotations of the turtle."""

    def __init__(
        self, node: Node, name: str, find_turtle: Callable[[], Turtle | None], on_goal: Callable[[GoalEvent], object]
    ) -> None:
        """Create the server. `find_turtle` returns the turtle, or None if it was killed."""
        self._log = node.get_logger()
        self._find_turtle = find_turtle
        self._on_goal = on_goal
        self._goals: list[tuple[Rotation, ServerGoalHandle]] = []
        self._feedback = RotateAbsolute.Feedback()
        self._action = node.resolve_service_name(f"{name}/rotate_absolute")
        self._server = _DeferringActionServer(
            node,
            RotateAbsolute,
            f"{name}/rotate_absolute",
            execute_callback=lambda _: RotateAbsolute.Result(),
            handle_accepted_callback=self._accept,
            cancel_callback=self._cancel,
            on_result_request=lambda goal_id: self._tell(goal_id, "result requested"),
        )

    def _accept(self, goal: ServerGoalHandle) -> None:
        self._tell(_id_of(goal), "accepted", goal.request)
        goal.execute()
        turtle = self._find_turtle()
        if turtle is None:
            goal.abort()
            self._give_result(goal, "aborted", RotateAbsolute.Result())
            return
        if turtle.rotation is not None:
            self._log.warning("Rotation goal received before a previous goal finished. Aborting previous goal")
        self._goals.append((turtle.rotate_to(goal.request.theta), goal))

    def _cancel(self, goal: ServerGoalHandle) -> CancelResponse:
        self._tell(_id_of(goal), "cancel requested")
        return CancelResponse.ACCEPT

    def _tell(self, goal_id: bytes, what: What, content: Any = None) -> None:  # noqa: ANN401 - a Goal or a Result
        self._on_goal(GoalEvent(self._action, TYPE, goal_id, what, content))

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
        assert rotation.end is not None
        if rotation.end == "succeeded":
            self._log.info("Rotation goal completed successfully")
            goal.succeed()
        elif rotation.end == "canceled":
            self._log.info("Rotation goal canceled")
            goal.canceled()
        else:
            goal.abort()
        self._give_result(goal, rotation.end, RotateAbsolute.Result(delta=rotation.delta))

    def _give_result(self, goal: ServerGoalHandle, end: What, result: RotateAbsolute.Result) -> None:
        self._tell(_id_of(goal), end, result)
        self._server.give_result(goal, result)

    @property
    def idle(self) -> bool:
        """Return whether no goal is active."""
        return not self._goals

    def destroy(self) -> None:
        """Remove the action from the graph."""
        self._server.destroy()


def _id_of(goal: ServerGoalHandle) -> bytes:
    return bytes(goal.goal_id.uuid)
