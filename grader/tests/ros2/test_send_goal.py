"""Ctrl-C cancels the goal of `ros2 action send_goal`, or the command says that it may not have been canceled."""

from __future__ import annotations

import os
import signal
from typing import TYPE_CHECKING

import pytest

from grader.tests.ros2.world import World, world

if TYPE_CHECKING:
    from collections.abc import Iterator

ROTATE = "/turtle1/rotate_absolute turtlesim/action/RotateAbsolute"
IMPATIENT = """
import sys
from grader.ros2 import main
from grader.ros2.action import send_goal
send_goal._CANCEL_S = 0.2
sys.argv[1:1] = ["action", "send_goal"]
main.main()
"""


@pytest.fixture(scope="module")
def still(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    """Create a world with turtlesim, but without a node that drives."""
    for made in world(tmp_path_factory.mktemp("still")):
        made.turtlesim()
        yield made


@pytest.mark.parametrize("ready", ["Sending goal:", "Goal accepted"])
def test_ctrl_c_cancels_a_goal_at_any_moment(ready: str, still: World) -> None:
    for _ in range(3):
        running = still.start(f"ros2 action send_goal {ROTATE} '{{theta: .nan}}'", ready)
        assert running.stop() == 2, running.lines
        assert [line for line in running.lines if "ancel" in line] == ["Canceling goal...", "Goal canceled."]


def test_an_action_server_that_does_not_respond_to_ctrl_c_is_reported(still: World) -> None:
    running = still.start(f"python3 -c '{IMPATIENT}' {ROTATE} '{{theta: .nan}}'", "Goal accepted")
    turtlesim = still.running[0].process.pid
    os.killpg(turtlesim, signal.SIGSTOP)
    try:
        assert running.stop() == 2
    finally:
        os.killpg(turtlesim, signal.SIGCONT)
    assert running.lines[-1] == "The action server did not respond, so it may still execute the goal."
