"""Run turtlesim in wall time, until Ctrl-C. `grader sim`, turtlesim_node and live.py use this module."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import threading
import time
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import rclpy
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.executors import SingleThreadedExecutor, TimeoutException
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from grader.errors import GraderError
from grader.ros.domain import wrong_domain
from grader.turtlesim.node import TurtlesimNode
from grader.turtlesim.turtle import FRAME_S

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from contextlib import AbstractContextManager
    from typing import Any, Literal

    from grader.turtlesim.canvas import Canvas

    Kind = Literal["page", "terminal"]
    OpenView = Callable[[Kind, int | None], AbstractContextManager["View"]]

_MOST_AT_ONCE = 200
"""The maximum number of callbacks per frame, so that a flood of messages cannot stop the turtle."""
_NO_LOG = "log directory"
"""The error message of rcl contains these words if the folder for the log files cannot be created."""
_NO_WINDOW = (
    "This turtlesim has no window. To see the turtle, stop turtlesim with Ctrl-C and start it again with --view "
    "(a page in the browser) or --view terminal."
)
"""This text is printed only on a terminal. Otherwise, the output is the same as the output of the real turtlesim."""
_ANOTHER = (
    "Another node in this ROS domain has the name {name}. If a second turtlesim is running in another terminal, both "
    "publish on the same topics, so `ros2 topic hz` shows twice the rate. Stop one of them with Ctrl-C."
)
"""This text, too, is printed only on a terminal."""
_LOOKS_FOR_ANOTHER = 60
"""The number of frames after which turtlesim looks for another node with its name again."""


class Feed(Protocol):
    """Callbacks for a view, and the canvas on which the turtles draw while the view is running."""

    namespace: str

    @property
    def canvas(self) -> Canvas:
        """The canvas that the view shows."""

    @property
    def on_command(self) -> Callable[..., Any]:
        """The callback for each command that arrives."""

    @property
    def on_publish(self) -> Callable[..., Any]:
        """The callback for each pose and each colour that the simulator publishes."""


class View(Protocol):
    """A view of the simulator.

    `paused` is true while the turtles' time is stopped. `open` is true until the view ends.
    """

    paused: bool
    open: bool
    kind: Kind

    @property
    def feed(self) -> Feed:
        """The callbacks and the canvas of the view."""

    def after_frame(self, node: TurtlesimNode) -> None:
        """Show the state after a frame, and handle the requests of the view."""


def main(open_view: OpenView, args: Sequence[str] | None = None) -> int:
    """Run turtlesim until Ctrl-C, SIGTERM or the end of a view in the terminal.

    Return the exit code: 0, the exit code of a GraderError, or 2 if the node could not be created, the picture could
    not be written, or ROS_DOMAIN_ID is invalid. Invalid arguments raise SystemExit.

    `open_view` starts the view for `--view` on the given port. If the port is None, the view chooses a port.
    """
    arguments = list(sys.argv if args is None else ["turtlesim_node", *args])
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    try:
        options = _options(remove_ros_args(arguments)[1:])
        if wrong_domain(os.environ):
            return _wrong(wrong_domain(os.environ))
        with ExitStack() as stack:
            view = stack.enter_context(open_view(options.view, options.port)) if options.view else None
            # rclpy's own signal handler would shut down the context in the middle of a frame.
            rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
            stack.callback(rclpy.try_shutdown)
            node = _node(view)
            if view is None and sys.stderr.isatty():
                print(_NO_WINDOW, file=sys.stderr, flush=True)
            spin(node, stop, view)
    except (InvalidParameterValueException, InvalidParameterTypeException, RuntimeError) as error:
        return _wrong(_first_line(error))
    except GraderError as error:
        _wrong(str(error))
        return error.exit_code
    if options.image is not None:
        try:
            node.save_image(options.image)
        except OSError as error:
            return _wrong(f"the picture could not be written: {error}")
    return 0


def _node(view: View | None) -> TurtlesimNode:
    if view is None:
        return TurtlesimNode()
    feed = view.feed
    node = TurtlesimNode(canvas=feed.canvas, on_command=feed.on_command, on_publish=feed.on_publish)
    feed.namespace = node.get_namespace()
    return node


def spin(node: TurtlesimNode, stop: threading.Event, view: View | None = None) -> None:
    """Compute a frame every 16 ms of CLOCK_MONOTONIC until `stop` is set. Missed frames are computed late, not skipped.

    When a view in the terminal ends, this function returns, too. When a page ends, the simulator continues.
    While the simulator is paused in the view, the turtles' time does not advance.
    """
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    begun = time.monotonic()
    ticks = frames = 0
    warned = False
    while not stop.is_set():
        early_s = begun + ticks * FRAME_S - time.monotonic()
        if early_s > 0:
            time.sleep(early_s)
        # Like the real turtlesim, handle messages that have arrived at the start of a frame.
        _handle_what_arrived(executor)
        if view is None or not view.paused:
            node.frame(frames * FRAME_S)
            frames += 1
        ticks += 1
        if not warned and ticks % _LOOKS_FOR_ANOTHER == 0 and sys.stderr.isatty():
            warned = _warn_of_another(node)
        if view is not None:
            view.after_frame(node)
            if not view.open:
                if view.kind == "terminal":
                    return
                node.get_logger().warning("The view has ended. turtlesim continues without it.")
                view = None


def _warn_of_another(node: TurtlesimNode) -> bool:
    """Print a warning if another node has the same name, and return whether this is the case."""
    own = (node.get_name(), node.get_namespace())
    if node.get_node_names_and_namespaces().count(own) < 2:
        return False
    print(_ANOTHER.format(name=node.get_fully_qualified_name()), file=sys.stderr, flush=True)
    return True


def _handle_what_arrived(executor: SingleThreadedExecutor) -> None:
    for _ in range(_MOST_AT_ONCE):
        try:
            handler, _, _ = executor.wait_for_ready_callbacks(timeout_sec=0.0)
        except TimeoutException:
            return
        handler()
        handler.result()


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="turtlesim_node",
        description="Run turtlesim without a window, in wall time, until Ctrl-C. Use --view to see the turtles.",
        epilog="Example: ros2 run turtlesim turtlesim_node --view",
    )
    parser.add_argument("--image", type=Path, metavar="FILE.png", help="write the canvas with the trails on exit")
    parser.add_argument(
        "--view",
        nargs="?",
        const="page",
        choices=("page", "terminal"),
        help="show the turtles: on a page on this machine (the default), or in this terminal",
    )
    parser.add_argument("--port", type=int, help="port of the page (default: the same as last time, or a free one)")
    options = parser.parse_args(arguments)
    if options.port is not None and options.view != "page":
        parser.error("--port needs --view or --view page, since only a page has a port")
    return options


def _wrong(what: str) -> int:
    print(f"turtlesim_node: {what}", file=sys.stderr)
    return 2


def _first_line(error: Exception) -> str:
    line = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
    return f"{line}. Choose a folder that you can write to: export ROS_LOG_DIR=FOLDER" if _NO_LOG in line else line
