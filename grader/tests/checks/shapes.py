"""Invented recordings of a learner's node, by name. Each recording contains commands and the turtle's motion."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from grader.tests.checks.made import DURATION_S, as_command, every, good, graph, recording
from grader.trial.recording import Command, Output, Pose, ProcessEnd

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.tests.checks.made import Timed
    from grader.trial.recording import Recording

TRACEBACK = """\
Traceback (most recent call last):
  File "/ws/install/my_robot_controller/lib/my_robot_controller/draw_circle", line 33, in <module>
    sys.exit(load_entry_point('my-robot-controller==0.1.0', 'console_scripts', 'draw_circle')())
  File "/ws/lib/python3.11/site-packages/my_robot_controller/draw_circle.py", line 21, in main
    rclpy.spin(DrawCircleNode())
  File "/opt/ros/jazzy/lib/python3.12/site-packages/rclpy/__init__.py", line 229, in spin
    executor.spin_once()
  File "/ws/lib/python3.11/site-packages/my_robot_controller/draw_circle.py", line 14, in send
    msg.linear.x = 1 / 0
ZeroDivisionError: division by zero
"""


def crashed(at_s: float) -> ProcessEnd:
    return ProcessEnd(by="itself", exit_code=1, t_s=at_s, stop_s=None)


def fields(linear: tuple[float, float, float], angular: tuple[float, float, float]) -> Recording:
    """Return the recording of a node that always publishes these values."""
    return recording(Command(t_s, t_s, linear, angular) for t_s, _, _ in every(0.5, 0.0, 0.0))


def polygon(sides_s: float, turns_s: float, angle: float, speed: float) -> list[Timed]:
    """Return commands at 2 Hz that alternate between driving straight on and turning on the spot."""
    pattern = [(speed, 0.0)] * round(sides_s / 0.5) + [(0.0, angle / turns_s)] * round(turns_s / 0.5)
    return [(t_s, *pattern[index % len(pattern)]) for index, (t_s, _, _) in enumerate(every(0.5, 0.0, 0.0))]


def uneven() -> list[Timed]:
    return [(t_s + 0.2 * (index % 2), v, w) for index, (t_s, v, w) in enumerate(every(0.5, 2.0, 1.0))]


def teleported(given: Recording, *, at_s: float = 5.0, name: str = "teleport_absolute") -> Recording:
    """Return the given run with the turtle moved half a metre to the left at the time `at_s`."""
    frames = given.frames
    moved = replace(frames, x=frames.x - 0.5 * (frames.t_s > at_s))
    return replace(given, frames=moved, interventions=(name,))


SHAPES: dict[str, Callable[[], Recording]] = {
    "good": good,
    "good elsewhere": lambda: recording(every(0.5, 2.0, 1.0), start=Pose(4.0, 6.0, 2.2)),
    "clockwise": lambda: recording(every(0.5, 2.0, -1.0)),
    "radius 2.2": lambda: recording(every(0.5, 2.2, 1.0)),
    "three quarters": lambda: recording(every(0.5, 2.0, 1.0, until_s=4.3)),
    "half speed": lambda: recording(every(0.5, 1.0, 0.5)),
    "square": lambda: recording(polygon(1.0, 1.0, math.pi / 2, 2.0)),
    "many sides": lambda: recording(polygon(0.5, 0.5, math.pi / 3, 2.0)),
    "straight on": lambda: recording(every(0.5, 0.3, 0.0)),
    "turns on the spot": lambda: recording(every(0.5, 0.0, 1.0)),
    "all zero": lambda: recording(every(0.5, 0.0, 0.0)),
    "no messages": lambda: recording([]),
    "wall": lambda: recording(every(0.5, 6.0, 1.0)),
    "straight into the wall": lambda: recording(every(0.5, 2.0, 0.0)),
    "stops and goes": lambda: recording(every(2.0, 2.0, 1.0)),
    "spiral": lambda: recording([(t_s, 1.0 + 0.1 * t_s, 1.0) for t_s, _, _ in every(0.5, 0.0, 0.0)]),
    "beside its place": lambda: recording([(0.1, 2.0, 0.0), *every(0.5, 2.0, 1.0)]),
    "nan": lambda: recording(every(0.5, math.nan, 1.0)),
    "infinity": lambda: recording(every(0.5, 2.0, math.inf)),
    "one hertz": lambda: recording(every(1.0, 2.0, 1.0)),
    "two seconds": lambda: recording(every(2.0, 2.0, 1.0)),
    "four hertz": lambda: recording(every(0.25, 2.0, 1.0)),
    "ten kilohertz": lambda: recording([(index / 10_000, 2.0, 1.0) for index in range(1, 99_000)]),
    "once": lambda: recording([(0.5, 2.0, 1.0)]),
    "twice": lambda: recording([(0.5, 2.0, 1.0), (1.0, 2.0, 1.0)]),
    "late": lambda: recording(every(0.5, 2.0, 1.0, first_s=3.7)),
    "uneven": lambda: recording(uneven()),
    "swapped": lambda: recording(every(0.5, 1.0, 2.0)),
    "degrees": lambda: recording(every(0.5, 2.0, math.degrees(1.0))),
    "angular.x": lambda: fields((2.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
    "linear.y": lambda: fields((0.0, 2.0, 0.0), (0.0, 0.0, 1.0)),
    "one wrong": lambda: recording([*every(0.5, 2.0, 1.0)[:-1], (9.504, 2.0, 1.001)]),
    "teleported": lambda: teleported(recording(every(0.5, 2.0, 1.0))),
    "crash": lambda: recording(
        every(0.5, 2.0, 1.0, until_s=4.3), end=crashed(4.5), sigint_t_s=4.5, stderr=Output(TRACEBACK)
    ),
    "crash at the start": lambda: recording([], end=crashed(-0.2), graphs=(), stderr=Output(TRACEBACK)),
    "ends early": lambda: recording(
        every(0.5, 2.0, 1.0, until_s=8.0), end=ProcessEnd(by="itself", exit_code=0, t_s=8.0, stop_s=None)
    ),
    "ends at once": lambda: recording([], end=ProcessEnd(by="itself", exit_code=0, t_s=-0.1, stop_s=None), graphs=()),
    "no node": lambda: recording([], graphs=(graph((), topic=None),)),
    "no publisher": lambda: recording([], graphs=(graph(topic=None),)),
    "other topic": lambda: recording([], graphs=(graph(topic="/turtle1/cmd_val"),)),
    "other type": lambda: recording([], graphs=(graph(type_="geometry_msgs/msg/TwistStamped"),)),
    "other name": lambda: recording(every(0.5, 2.0, 1.0), graphs=(graph(("/draw_cirle",)),)),
    "ignores Ctrl-C": lambda: recording(
        every(0.5, 2.0, 1.0), end=ProcessEnd(by="SIGKILL", exit_code=-9, t_s=DURATION_S, stop_s=5.0)
    ),
    "slow stop": lambda: recording(
        every(0.5, 2.0, 1.0), end=ProcessEnd(by="SIGINT", exit_code=0, t_s=DURATION_S, stop_s=4.0)
    ),
    "more after Ctrl-C": lambda: recording(
        [*map(as_command, every(0.5, 2.0, 1.0)), Command(10.1, 10.1, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))]
    ),
}
"""Maps the name of a run to a function that makes the recording."""
