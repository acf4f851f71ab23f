"""The ROS 2 interface of one turtle: its topics, services and action."""

from __future__ import annotations

import math
from contextlib import ExitStack
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from geometry_msgs.msg import Twist
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message, serialize_message
from turtlesim.msg import Color, Pose
from turtlesim.srv import SetPen, TeleportAbsolute, TeleportRelative

from grader.turtlesim.rotate_absolute import RotateAbsoluteServer
from grader.turtlesim.turtle import SIDE_M, Pen

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.node import Node
    from rclpy.service import Service

    from grader.turtlesim.goal_event import GoalEvent
    from grader.turtlesim.late_answers import LateAnswers
    from grader.turtlesim.turtle import Rgb, State, Turtle
    from grader.turtlesim.world import World

# The defaults are reliable and volatile.
QOS = QoSProfile(depth=7)

_FLOAT32_MAX = 3.4028234663852886e38


@dataclass(frozen=True)
class Hooks:
    """Callbacks for messages that the simulator receives and sends. `data` is the serialized message (CDR).

    `on_command(topic, data, twist)` is called when a command has arrived, before it moves the turtle.
    `on_publish(topic, type, data)` is called when a pose or a colour is published. `on_intervention(name)` is called
    when a client calls a service ("spawn"), sends a goal ("rotate_absolute") or sets a parameter ("set_background" if
    only colours are set, otherwise "set_parameters"). `on_call(service, type, request, response, waited_s)` is called
    before the response to a call is sent, `waited_s` (s) after the call arrived. `on_goal(event)` is called for each
    event of an action goal. If `late` is not None, it delays the calls and their responses.
    """

    on_command: Callable[[str, bytes, Any], object]
    on_publish: Callable[[str, str, bytes], object]
    on_intervention: Callable[[str], object]
    on_call: Callable[[str, str, Any, Any, float], object]
    on_goal: Callable[[GoalEvent], object]
    late: LateAnswers | None = None

    def serve(self, node: Node, service_type: Any, name: str, handle: Callable[[Any, Any], Any]) -> Service:  # noqa: ANN401
        """Create a service of the node. Each call is reported to `on_call`."""

        def handle_and_tell(request: Any, response: Any, waited_s: float = 0.0) -> Any:  # noqa: ANN401
            response = handle(request, response)
            self.on_call(service.service_name, type_name, request, response, waited_s)
            return response

        type_name = f"{service_type.__module__.partition('.')[0]}/srv/{service_type.__name__}"
        service = node.create_service(service_type, name, handle_and_tell)
        if self.late is not None:
            self.late.delay(service, handle_and_tell)
        return service


class TurtleInterface:
    """The topics, services and action of the turtle called `name`. Those of turtle1 remain after a reset."""

    def __init__(
        self, node: Node, name: str, world: World, hooks: Hooks, pose_every: int = 1, pose_from_s: float = 0.0
    ) -> None:
        """Add the turtle to the ROS graph.

        If rclpy rejects the turtle's name with an error, nothing remains in the graph.
        """
        self.name = name
        self._world = world
        self._hooks = hooks
        self._pose_every, self._pose_from_s = pose_every, pose_from_s
        self._frames = 0
        self._log = node.get_logger()
        with ExitStack() as parts:
            command = node.create_subscription(Twist, f"{name}/cmd_vel", self._command, QOS, raw=True)
            parts.callback(node.destroy_subscription, command)
            self._command_topic: str = command.topic_name
            self._pose = _Sender(node, Pose, f"{name}/pose", parts)
            self._color = _Sender(node, Color, f"{name}/color_sensor", parts)
            self._state: State | None = None
            self._observed: Rgb | None = None
            for service_type, service_name, serve in (
                (SetPen, "set_pen", self._set_pen),
                (TeleportRelative, "teleport_relative", self._teleport_relative),
                (TeleportAbsolute, "teleport_absolute", self._teleport_absolute),
            ):
                service = hooks.serve(node, service_type, f"{name}/{service_name}", serve)
                parts.callback(node.destroy_service, service)
            self._rotate = RotateAbsoluteServer(node, name, self._turtle, self._goal_event)
            parts.callback(self._rotate.destroy)
            self._parts = parts.pop_all()

    def destroy(self) -> None:
        """Remove the turtle from the ROS graph."""
        self._parts.close()

    @property
    def idle(self) -> bool:
        """Return whether no goal of the action is active."""
        return self._rotate.idle

    def before_frame(self) -> None:
        """Pass cancel requests on to the turtle before it moves."""
        if not self._rotate.idle:
            self._rotate.before_frame()

    def after_frame(self, now_s: float) -> None:
        """Publish the pose and the colour if they are due at `now_s` (s). Send feedback and results of rotations."""
        if not self._rotate.idle:
            self._rotate.after_frame()
        turtle = self._turtle()
        if turtle is None:
            return
        if turtle.clamped_from is not None:
            x, y = turtle.clamped_from
            # In this message, turtlesim counts y from the top.
            self._log.warning(f"Oh no! I hit the wall! (Clamping from [x={x:f}, y={SIDE_M - y:f}])")
        self._publish(turtle, now_s)

    def _publish(self, turtle: Turtle, now_s: float) -> None:
        state = turtle.state()
        if state != self._state:
            self._state = state
            pose = self._pose.message
            pose.x, pose.y, pose.theta = _narrow(state.x), _narrow(state.y), state.theta
            pose.linear_velocity, pose.angular_velocity = _narrow(state.linear), _narrow(state.angular)
            self._pose.serialize()
        if turtle.color != self._observed:
            self._observed = turtle.color
            color = self._color.message
            color.r, color.g, color.b = turtle.color
            self._color.serialize()
        self._frames += 1
        if self._frames % self._pose_every:
            return
        late = max(now_s, 0.0) < self._pose_from_s
        for sender in (self._color,) if late else (self._pose, self._color):
            sender.publish(sender.data)
            self._hooks.on_publish(sender.topic, sender.type_name, sender.data)

    def _goal_event(self, event: GoalEvent) -> None:
        if event.what == "accepted":
            self._hooks.on_intervention("rotate_absolute")
        self._hooks.on_goal(event)

    def _turtle(self) -> Turtle | None:
        return self._world.turtles.get(self.name)

    def _command(self, data: bytes) -> None:
        try:
            twist = deserialize_message(data, Twist)
        except Exception:
            self._log.error(f"A message on {self._command_topic} is not a Twist; ignored")
            return
        self._hooks.on_command(self._command_topic, data, twist)
        turtle = self._turtle()
        if turtle is None:
            return
        if turtle.rotation is not None:
            self._log.warning("Velocity command received during rotation goal. Aborting goal")
        self._world.command(self.name, twist.linear.x, twist.linear.y, twist.angular.z)

    def _set_pen(self, request: SetPen.Request, response: SetPen.Response) -> SetPen.Response:
        self._hooks.on_intervention("set_pen")
        turtle = self._turtle()
        if turtle is not None:
            if request.off:
                turtle.pen = replace(turtle.pen, down=False)
            else:
                # A width of 0 means a pen of one pixel, and not the previous width.
                turtle.pen = Pen((request.r, request.g, request.b), request.width or 1)
        return response

    def _teleport_absolute(
        self, request: TeleportAbsolute.Request, response: TeleportAbsolute.Response
    ) -> TeleportAbsolute.Response:
        self._hooks.on_intervention("teleport_absolute")
        turtle = self._turtle()
        if turtle is not None:
            turtle.teleport_absolute(request.x, request.y, request.theta)
        return response

    def _teleport_relative(
        self, request: TeleportRelative.Request, response: TeleportRelative.Response
    ) -> TeleportRelative.Response:
        self._hooks.on_intervention("teleport_relative")
        turtle = self._turtle()
        if turtle is not None:
            turtle.teleport_relative(request.linear, request.angular)
        return response


class _Sender:
    """A publisher with its last message, which is serialized only when it changes.

    A turtle that stands still always sends the same message.
    """

    def __init__(self, node: Node, message_type: type, topic: str, parts: ExitStack) -> None:
        publisher = node.create_publisher(message_type, topic, QOS)
        parts.callback(node.destroy_publisher, publisher)
        self.publish = publisher.publish
        self.topic: str = publisher.topic_name
        self.type_name = f"turtlesim/msg/{message_type.__name__}"
        self.message: Any = message_type()
        self.data = b""

    def serialize(self) -> None:
        self.data = serialize_message(self.message)


def _narrow(value: float) -> float:
    """Return the value for a float32 field. Values that are out of range become infinity, as in C++."""
    if abs(value) > _FLOAT32_MAX:
        return math.copysign(math.inf, value)
    return value
