"""A function that test_live.py runs in a process with ROS 2."""

from __future__ import annotations

import io
import struct
import sys
import threading
import time
from types import SimpleNamespace

from grader.turtlesim.live import EVERY, _Screen
from grader.turtlesim.turtle import Pen
from grader.turtlesim.world import World

HANG_S = 60.0


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
    sys.stdout = before
    return _count(written.getvalue())


def _count(data: bytes) -> int:
    count = 0
    while data:
        (length,) = struct.unpack(">I", data[:4])
        data = data[4 + length :]
        count += 1
    return count
