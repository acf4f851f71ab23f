"""Test turtle_teleop_key, draw_square and mimic on the real ROS 2, with turtlesim, as a user starts them."""

from __future__ import annotations

import itertools
import math
import os
import signal
import time
from typing import TYPE_CHECKING

import pexpect
import pytest

from grader.tests.both_worlds import REAL_ROS2, of_our_turtlesim
from grader.tests.ros2.world import World, world
from grader.tests.waiting import HANG_S, until
from grader.turtlesim.turtle import FRAME_S

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from grader.tests.ros2.world import Running

UP, LEFT = "\x1b[A", "\x1b[D"
pytestmark = of_our_turtlesim
TELEOP = "ros2 run turtlesim turtle_teleop_key"


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    yield from world(tmp_path_factory.mktemp("alone"))


@pytest.fixture
def beside(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    yield from world(tmp_path_factory.mktemp("beside"))


def terminal(of: World, command: str = "bash --norc --noprofile") -> pexpect.spawn:
    program, *arguments = command.split()
    return pexpect.spawn(program, arguments, env=of.env, cwd=of.home, encoding="utf-8", timeout=HANG_S)


def poses(of: World, turtle: str) -> Running:
    """Return a process that prints lines x,y,theta,linear,angular of a turtle, starting now."""
    # With the usual depth, poses are lost if the command has to wait for a processor, and it prints a report.
    options = "--csv --no-lost-messages --qos-reliability reliable --qos-depth 1000"
    return of.start(f"ros2 topic echo {options} /{turtle}/pose", ",")


def pose_of(line: str) -> tuple[float, ...]:
    """Return x, y and theta (m, m, rad), or an empty tuple for another line."""
    values = line.split(",")
    return tuple(map(float, values[:3])) if len(values) == 5 else ()


def until_last(observed: Running, place: Callable[[tuple[float, ...]], bool]) -> None:
    """Wait until the last pose is as described. The turtle must stay there."""
    until(lambda: bool(pose := pose_of(observed.lines[-1])) and place(pose))


AGAIN_S = 20.0


def press_until(keys: pexpect.spawn, key: str, there: Callable[[], bool]) -> None:
    """Press a key until the condition is true. The first press has no effect if turtlesim is discovered late."""
    pressed_at = -AGAIN_S

    def pressed() -> bool:
        nonlocal pressed_at
        if not there() and time.monotonic() - pressed_at > AGAIN_S:
            pressed_at = time.monotonic()
            keys.send(key)
        return there()

    until(pressed)


def has(observed: Running, end: str) -> bool:
    return any(end in line for line in observed.lines)


def turning(observed: Running) -> int:
    """Return the number of poses in which the turtle turns in the direction of a goal."""
    return sum(line.endswith((",0.0,1.0", ",0.0,-1.0")) for line in observed.lines)


def ended_goals(turtlesim: Running) -> int:
    return sum("Rotation goal completed" in line or "Rotation goal canceled" in line for line in turtlesim.lines)


# --- turtle_teleop_key ----------------------------------------------------------------------------------------------


def test_keys_drive_and_turn_the_turtle(beside: World) -> None:
    turtlesim = beside.turtlesim()
    observed = poses(beside, "turtle1")
    keys = terminal(beside, f"{TELEOP} --ros-args -p scale_linear:=0.5")
    keys.expect("Q quits")
    press_until(keys, UP, lambda: has(observed, ",0.5,0.0"))
    press_until(keys, LEFT, lambda: has(observed, ",0.0,2.0"))
    press_until(keys, "r", lambda: has(turtlesim, "Rotation goal completed"))
    until_last(observed, lambda pose: pose[2] == pytest.approx(math.pi / 2, abs=0.05))
    # A turn lasts for three seconds. On a busy machine, it may have ended before it is canceled.
    for key in itertools.cycle("vr"):
        turns, ends = turning(observed), ended_goals(turtlesim)
        keys.send(key)
        until(lambda turns=turns: turning(observed) > turns)  # type: ignore[misc]
        keys.send("f")
        until(lambda ends=ends: ended_goals(turtlesim) > ends)  # type: ignore[misc]
        if has(turtlesim, "Rotation goal canceled"):
            break
    keys.send("q")
    keys.expect(pexpect.EOF)
    keys.close()
    assert keys.exitstatus == 0


@pytest.mark.parametrize(
    "how",
    [
        "Ctrl-C",
        "SIGHUP",
        "Ctrl-Z, fg, q",
        *(pytest.param(how, marks=pytest.mark.exhaustive) for how in ("q", "Ctrl-\\", "SIGTERM")),
    ],
)
def test_the_terminal_is_left_as_it_was(alone: World, how: str) -> None:
    shell = terminal(alone)
    shell.sendline("PS1=ready''; echo $$; stty -a > before")
    shell.expect("ready")
    shell.sendline(TELEOP)
    shell.expect("Q quits")
    job = os.tcgetpgrp(shell.child_fd)
    if how == "Ctrl-Z, fg, q":
        shell.send("\x1a")
        shell.expect("ready")
        shell.sendline("fg")
        shell.expect(TELEOP)
        # The program receives single keys again.
        until(lambda: not shell.getecho())
    if how.startswith("SIG"):
        os.kill(job, signal.Signals[how])
    else:
        shell.send({"Ctrl-C": "\x03", "Ctrl-\\": "\x1c"}.get(how, "q"))
    shell.expect("ready")
    shell.sendline("stty -a > after; exit")
    shell.expect(pexpect.EOF)
    shell.close()
    assert (alone.home / "after").read_text() == (alone.home / "before").read_text()


def test_it_ends_when_the_terminal_is_lost(alone: World) -> None:
    keys = terminal(alone, TELEOP)
    keys.expect("Q quits")
    # `close` would kill the process.
    keys.ptyproc.fileobj.close()
    keys.ptyproc.closed = keys.closed = True
    until(lambda: not keys.isalive())
    # The process ended by itself. The real `ros2 run` ends together with the terminal.
    assert REAL_ROS2 or keys.signalstatus is None


def test_it_says_when_nobody_listens(alone: World) -> None:
    keys = terminal(alone, TELEOP)
    keys.expect("Q quits")
    keys.send(UP)
    keys.expect(r"No subscription or action server for /turtle1/cmd_vel was found in ROS domain [0-9]+\.")
    keys.send("q")
    keys.expect(pexpect.EOF)


@pytest.mark.parametrize("stdin", ["echo | ", ""])
def test_it_says_that_it_needs_a_terminal(alone: World, stdin: str) -> None:
    done = alone.run(f"{stdin}{TELEOP}")
    assert done.code == 1
    assert "its standard input is not a terminal" in done.stderr
    assert done.stdout == "[ros2run]: Process exited with failure 1\n"


# --- draw_square, mimic ---------------------------------------------------------------------------------------------


def test_draw_square_resets_and_drives_around_the_corner(beside: World) -> None:
    beside.turtlesim()
    moved = beside.run("ros2 service call /turtle1/teleport_absolute turtlesim/srv/TeleportAbsolute '{x: 1.0, y: 9.0}'")
    assert moved.code == 0
    observed = poses(beside, "turtle1")
    square = beside.start("ros2 run turtlesim draw_square")
    # test_square_velocity.py tests the rest of the square on the simulator's motion, without waiting for it.
    square.wait_for("Driving to [7.54, 7.54]")
    until_last(observed, lambda pose: pose[2] == pytest.approx(math.pi / 2, abs=0.05) and pose[1] > 5.6)
    assert square.stop() == 0
    assert not any("Traceback" in line for line in square.lines)
    path = [pose for line in observed.lines if (pose := pose_of(line)) and pose[:2] != (1.0, 9.0)]
    # The turtle is reset to the middle, drives 2 m to the right, turns, and drives upwards.
    assert path[0] == pytest.approx((5.544445, 5.544445, 0.0), abs=1e-4)
    assert max(abs(y - 5.544445) for x, y, _ in path if x < 7.5) < 0.02
    assert path[-1][0] == pytest.approx(7.544445, abs=0.02)


def test_mimic_drives_one_turtle_as_the_other_moves(beside: World) -> None:
    beside.turtlesim()
    assert "turtle2" in beside.run("ros2 service call /spawn turtlesim/srv/Spawn '{x: 2.0, y: 2.0}'").stdout
    beside.start("ros2 run turtlesim mimic --ros-args -r input/pose:=turtle1/pose -r output/cmd_vel:=turtle2/cmd_vel")
    first, second = poses(beside, "turtle1"), poses(beside, "turtle2")
    twist = "{linear: {x: 0.75}, angular: {z: -0.25}}"
    beside.start(f"ros2 topic pub -r 10 /turtle1/cmd_vel geometry_msgs/msg/Twist '{twist}'")
    first.wait_for(",0.75,-0.25")
    # The velocity is the same in several frames, so the turtle moves.
    second.wait_for(",0.75,-0.25", times=round(1.0 / FRAME_S))
    places = [pose_of(line)[:2] for line in second.lines if line.endswith(",0.75,-0.25")]
    assert max(math.dist((2.0, 2.0), place) for place in places) > 0.5
