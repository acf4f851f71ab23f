"""Functions that test_live.py runs in processes with ROS 2."""

from __future__ import annotations

import io
import struct
import sys
import threading
import time
from types import SimpleNamespace

import rclpy

from grader.tests.waiting import HANG_S
from grader.turtlesim import standalone
from grader.turtlesim.live import EVERY, _Screen
from grader.turtlesim.node import TurtlesimNode
from grader.turtlesim.turtle import FRAME_S, Pen
from grader.turtlesim.world import World


def pictures_of_a_turtle_that_stands_still(clears: bool) -> int:
    """Return the number of pictures. If `clears` is true, the trail is cleared between the frames."""
    written, before = io.BytesIO(), sys.stdout
    sys.stdout = SimpleNamespace(buffer=written)
    world = World()
    world.canvas.line(1.0, 1.0, 9.0, 9.0, Pen())
    screen = _Screen(world, threading.Event())
    screen.after_frame()
    deadline = time.monotonic() + HANG_S
    while not written.getvalue() and time.monotonic() < deadline:
        time.sleep(0.01)
    if clears:
        world.canvas.clear()
    for _ in range(EVERY):
        screen.after_frame()
    screen.close()
    screen._thread.join(HANG_S)  # on a busy machine, the last picture takes longer than `close` waits for it
    sys.stdout = before
    return _count(written.getvalue())


def _count(data: bytes) -> int:
    count = 0
    while data:
        (length,) = struct.unpack(">I", data[:4])
        data = data[4 + length :]
        count += 1
    return count


class Simulated:
    """A clock with the functions of `time` that `spin` uses. Its time advances only while a program sleeps."""

    def __init__(self) -> None:
        self.now_s = 0.0

    def monotonic(self) -> float:
        return self.now_s

    def sleep(self, duration_s: float) -> None:
        self.now_s += duration_s


def late_frames() -> list[tuple[float, float]]:
    """Return the times of the frames of a run (s), and when they were computed (s).

    The fifth frame takes as long as ten frames should.
    """
    frames: list[tuple[float, float]] = []
    stop, clock = threading.Event(), Simulated()

    class Slow(TurtlesimNode):
        def frame(self, now_s: float) -> None:
            super().frame(now_s)
            frames.append((now_s, clock.now_s))
            if len(frames) == 5:
                clock.sleep(10 * FRAME_S)
            if len(frames) == 30:
                stop.set()

    vars(standalone)["time"] = clock
    rclpy.init(args=[])
    standalone.spin(Slow(), stop)
    rclpy.shutdown()
    return frames
