"""Ctrl-C ends a command quietly also if rclpy replaces the KeyboardInterrupt by another exception."""

from __future__ import annotations

import signal
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.tests.both_worlds import of_our_turtlesim
from grader.tests.ros2 import world

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.tests.ros2.world import World

IN_A_CONSTRUCTOR = """
import os, signal, sys
from turtlesim.msg import Pose


def interrupted(pose, **fields):
    constructor(pose, **fields)
    if sys._getframe(1).f_code.co_name == "_take_subscription":
        print("the signal arrives", flush=True)
        signal.raise_signal(signal.Signals[os.environ["STOP"]])


constructor, Pose.__init__ = Pose.__init__, interrupted
"""
"""rclpy takes a message in C++, which calls the constructor of its class. A signal arrives during this call."""


@pytest.fixture(scope="module")
def ours(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    for made in world.world(tmp_path_factory.mktemp("replaced")):
        made.turtlesim()
        yield made


def ended(ours: World, start: str, arguments: str, number: signal.Signals) -> tuple[int, list[str]]:
    """Return the exit code, and the lines after the one before the signal."""
    Path(ours.home, "program.py").write_text(f"{IN_A_CONSTRUCTOR}\n{start}")
    running = ours.start(f"python program.py {arguments}", "the signal arrives", STOP=number.name)
    code = running.stop(0)
    return code, running.lines[running.lines.index("the signal arrives") + 1 :]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_of_a_verb(ours: World, number: signal.Signals) -> None:
    start = "from grader.ros2.main import main\nmain()"
    assert ended(ours, start, "topic echo --csv /turtle1/pose", number) == (number, [])


@of_our_turtlesim
def test_of_a_program(ours: World) -> None:
    start = "from grader.turtlesim.programs.mimic import main\nsys.exit(main())"
    assert ended(ours, start, "--ros-args -r input/pose:=/turtle1/pose", signal.SIGINT) == (0, [])
