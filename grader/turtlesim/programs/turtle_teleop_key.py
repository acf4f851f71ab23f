"""turtle_teleop_key: drive the turtle with the arrow keys, and turn it with the keys around F."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from contextlib import ExitStack, suppress
from functools import partial
from typing import TYPE_CHECKING, Any

import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from turtlesim.action import RotateAbsolute

from grader.common.interrupts import stops_deferred
from grader.ros.in_order import InOrder
from grader.turtlesim.programs.raw_terminal import is_terminal, keyboard
from grader.turtlesim.programs.teleop_keys import Cancel, Drive, Quit, Turn, keys

if TYPE_CHECKING:
    from collections.abc import Callable

_HELP = """\
The arrow keys drive and turn the turtle, for one second per key press.
    E R T
    D   G   turn the turtle to the direction from F to the key: G east, R north, D west, V south.
    C V B
F stops turning, Q quits."""
_NO_TERMINAL = (
    "turtle_teleop_key reads keys from a terminal, but its standard input is not a terminal. It may be a pipe or a "
    "file. Start the program in a separate terminal: ros2 run turtlesim turtle_teleop_key"
)
_DISCOVERY_S = 2.0
"""The maximum time (s), from the start of the node, to wait for the discovery of turtlesim."""


class Teleop(Node):
    """The node teleop_turtle. A live view gives this node another name, chooses the turtle, and hides its output."""

    def __init__(
        self,
        name: str = "teleop_turtle",
        turtle: str = "turtle1",
        tell: Callable[[str], object] | None = None,
    ) -> None:
        super().__init__(name)
        self._tell = tell or partial(print, flush=True)
        self.declare_parameter("scale_linear", 2.0)
        self.declare_parameter("scale_angular", 2.0)
        self._publisher = self.create_publisher(Twist, f"{turtle}/cmd_vel", 1)
        self._rotate = ActionClient(self, RotateAbsolute, f"{turtle}/rotate_absolute")
        self._action = self.resolve_service_name(f"{turtle}/rotate_absolute")
        self._goal: Any = None
        self._begun = time.monotonic()

    def drive(self, key: Drive) -> None:
        """Publish one command. Print a message if no node subscribes to it."""
        self._see_that(lambda: self._publisher.get_subscription_count() > 0, self._publisher.topic_name)
        twist = Twist()
        twist.linear.x = key.linear * self.get_parameter("scale_linear").value
        twist.angular.z = key.angular * self.get_parameter("scale_angular").value
        self._publisher.publish(twist)

    async def turn(self, key: Turn) -> None:
        """Send a goal if the action has a server. When a new goal arrives, turtlesim aborts the previous goal."""
        if not self._see_that(self._rotate.server_is_ready, self._action):
            return
        goal = await self._rotate.send_goal_async(RotateAbsolute.Goal(theta=key.theta))
        if goal.accepted:
            self._goal = goal

    async def cancel(self) -> None:
        """Send a request to cancel the last goal, if any. A goal that has ended is not affected."""
        if self._goal is not None:
            await self._goal.cancel_goal_async()

    def destroy_node(self) -> None:
        """Remove the node from the graph. If the action client remained, it would keep the node in the graph."""
        self._rotate.destroy()
        super().destroy_node()

    def _see_that(self, somebody: Callable[[], bool], name: str) -> bool:
        """Return whether `somebody` returns true now, or within two seconds of the start. If not, print a message."""
        while not somebody() and time.monotonic() < self._begun + _DISCOVERY_S:
            time.sleep(0.01)
        there = somebody()
        if not there:
            domain = os.environ.get("ROS_DOMAIN_ID") or "0"
            self._tell(
                f"No subscription or action server for {name} was found in ROS domain {domain}. Is turtlesim running?"
            )
        return there


def main() -> int:
    """Run the node until Q or Ctrl-C, or until the terminal is closed. Return 0, or 1 if there is no terminal."""
    if not is_terminal():
        print(_NO_TERMINAL, file=sys.stderr)
        return 1
    # Python's signal handler must interrupt the wait for a key. The handler of rclpy interrupts only waits of rclpy.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with suppress(KeyboardInterrupt), ExitStack() as stack:
        with stops_deferred():
            rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
            stack.callback(rclpy.try_shutdown)
            node = Teleop()
            stack.callback(node.destroy_node)
            executor = SingleThreadedExecutor()
            executor.add_node(node)
            spinning = threading.Thread(target=_spin, args=[executor], daemon=True)
            spinning.start()
            stack.callback(spinning.join)
            stack.callback(executor.shutdown)
        with keyboard() as read:
            print(_HELP, flush=True)
            _follow(read, node, InOrder(executor))
    return 0


def _spin(executor: SingleThreadedExecutor) -> None:
    with suppress(ExternalShutdownException):
        executor.spin()


def _follow(read: Callable[[], bytes | None], node: Teleop, calls: InOrder) -> None:
    """Handle the keys until Q is pressed or the terminal is closed."""
    rest = ""
    while data := read():
        typed, rest = keys(rest + data.decode("latin-1"))
        for key in typed:
            if isinstance(key, Quit):
                return
            if isinstance(key, Drive):
                node.drive(key)
            elif isinstance(key, Turn):
                calls.call(node.turn, key)
            elif isinstance(key, Cancel):
                calls.call(node.cancel)


if __name__ == "__main__":
    sys.exit(main())
