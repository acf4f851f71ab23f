"""A program of the domain announces names that ROS 2 does not accept, with control sequences or invalid UTF-8."""

from __future__ import annotations

import os
import pty
import shlex
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.tests.both_worlds import of_the_wheels
from grader.tests.ros2.world import World
from grader.tests.ros2.world import world as new_world
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = of_the_wheels
NAMED = Path(__file__).with_name("any_name.py")
CLIPBOARD = b"\x1b]52;c;ZXZpbA==\x07\x1b[1A\x1b[2K\nforged"
CLIPBOARD_IN_YAML = r"\e]52;c;ZXZpbA==\a"
NOT_UTF8 = b"\xff\xfe\xe9"
COMMANDS = (
    *("ros2 node list -a", "ros2 topic list -v", "ros2 topic info -v /words", "ros2 topic info -v /parameter_events"),
    *("ros2 service list", "ros2 action list", "ros2 param list", "ros2 node info /valid", "rqt_graph --all --text"),
)


@pytest.fixture
def world(tmp_path: Path) -> Iterator[World]:
    yield from new_world(tmp_path)


def announce(world: World, name: bytes) -> None:
    world.start(f"{shlex.quote(sys.executable)} {NAMED} {name.hex()}", "announced")


def test_a_name_with_control_sequences_neither_stops_a_command_nor_reaches_its_output(world: World) -> None:
    announce(world, CLIPBOARD)
    for command in COMMANDS:
        done = world.run(command)
        assert (command, done.code, done.stderr) == (command, 0, "")
        assert "\x1b" not in done.stdout, command
    assert "/valid" in world.run("ros2 node list").stdout


def test_a_name_that_is_not_utf8_is_reported(world: World) -> None:
    announce(world, NOT_UTF8)
    for command in COMMANDS:
        done = world.run(command)
        assert (command, done.code) == (command, 1)
        assert "has a name in the graph that is not valid UTF-8" in done.stderr, done.stderr
        assert "Traceback" not in done.stderr


def test_a_daemon_ends_with_a_sentence(world: World) -> None:
    announce(world, NOT_UTF8)
    done = world.run(f"{shlex.quote(sys.executable)} -m grader.ros2.daemon.server", XDG_RUNTIME_DIR=str(world.home))
    assert done.code == 1
    assert "not valid UTF-8" in done.stderr
    assert "Traceback" not in done.stderr


def printed_on_a_terminal(command: str, env: dict[str, str]) -> bytes:
    """Run a command whose standard output is a terminal, and return all of its output."""
    above, below = pty.openpty()
    with os.fdopen(above, "rb", buffering=0) as terminal:
        with os.fdopen(below, "wb") as output:
            running = subprocess.Popen(["bash", "-c", command], env=env, stdin=subprocess.DEVNULL, stdout=output)
        received = []
        with suppress(OSError):  # the end of the output
            while part := terminal.read(10_000):
                received.append(part)
    assert running.wait(HANG_S) == 0
    return b"".join(received)


@pytest.mark.parametrize(
    ("command", "shown"),
    [("ros2 topic echo --csv --once /words", b"52;c;ZXZpbA=="), ("rqt_graph --all --text", b"52;c;ZXZpbA==")],
)
def test_a_terminal_gets_no_control_sequence(world: World, command: str, shown: bytes) -> None:
    world.start(f"""ros2 topic pub /words std_msgs/msg/String '{{data: "{CLIPBOARD_IN_YAML}"}}'""", "publishing")
    announce(world, CLIPBOARD)
    printed = printed_on_a_terminal(command, world.env)
    assert b"\x1b" not in printed
    assert shown in printed


@pytest.mark.parametrize("service", ["kill turtlesim/srv/Kill", "spawn turtlesim/srv/Spawn"])
def test_turtlesim_prints_a_name_on_one_line_and_without_control_sequences(world: World, service: str) -> None:
    turtlesim = world.turtlesim()
    request = f'{{name: "{CLIPBOARD_IN_YAML}\\nforged"}}'
    world.run(f"ros2 service call /{service} '{request}'")
    turtlesim.wait_for("forged")
    assert [line for line in turtlesim.lines if "\x1b" in line or line.startswith("forged")] == []
