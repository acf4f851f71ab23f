"""turtlesim alone at wall time: what `grader sim` and the executable turtlesim_node run, until Ctrl-C."""

from __future__ import annotations

import argparse
import signal
import sys
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING

import rclpy
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.executors import SingleThreadedExecutor, TimeoutException
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from grader.simulator.node import TurtlesimNode
from grader.simulator.turtle import FRAME_S

if TYPE_CHECKING:
    from collections.abc import Sequence

_MOST_AT_ONCE = 200
"""Callbacks handled before a frame: a flood of messages must not stop the turtle."""


def main(args: Sequence[str] | None = None) -> int:
    """Run turtlesim; return the exit code: 0 after Ctrl-C, 2 for arguments that are wrong."""
    arguments = list(sys.argv if args is None else ["turtlesim_node", *args])
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    try:
        options = _options(remove_ros_args(arguments)[1:])
        # rclpy's own handler would shut the context down in the middle of a frame.
        rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
        node = TurtlesimNode()
    except (InvalidParameterValueException, InvalidParameterTypeException, RuntimeError) as error:
        rclpy.try_shutdown()
        return _wrong(_first_line(error))
    spin(node, stop)
    rclpy.try_shutdown()
    if options.image is not None:
        try:
            node.save_image(options.image)
        except OSError as error:
            return _wrong(f"the picture could not be written: {error}")
    return 0


def spin(node: TurtlesimNode, stop: threading.Event) -> None:
    """Make a frame every 16 ms of CLOCK_MONOTONIC until `stop`. A late frame is caught up, none is left out."""
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    begun = time.monotonic()
    frame = 0
    while not stop.is_set():
        due_s = frame * FRAME_S
        early_s = begun + due_s - time.monotonic()
        if early_s > 0:
            time.sleep(early_s)
        # As turtlesim does: what has arrived is handled at the start of a frame.
        _handle_what_arrived(executor)
        node.frame(due_s)
        frame += 1


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
        prog="turtlesim_node", description="A headless turtlesim at wall time, until Ctrl-C."
    )
    parser.add_argument("--image", type=Path, metavar="FILE.png", help="write the canvas with the trails on exit")
    return parser.parse_args(arguments)


def _wrong(what: str) -> int:
    print(f"turtlesim_node: {what}", file=sys.stderr)
    return 2


def _first_line(error: Exception) -> str:
    return str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
