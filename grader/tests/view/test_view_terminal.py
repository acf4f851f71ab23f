"""turtlesim_node --view terminal in a separate terminal: it draws, drives, and restores the terminal."""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING

import pexpect
import pytest

from grader.tests.both_worlds import OUR_TURTLESIM, REAL_TURTLESIM
from grader.tests.ros2.world import World, world
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Iterator

UP = "\x1b[A"
VIEW = f"{OUR_TURTLESIM} --view terminal"
COLOURS = {"TERM": "xterm-256color", "COLORTERM": "truecolor"}
SEA = "48;2;69;86;255"


@pytest.fixture(scope="module")
def system(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    yield from world(tmp_path_factory.mktemp("terminal"))


def shell(of: World, **env: str) -> pexpect.spawn:
    made = pexpect.spawn(
        "bash",
        ["--norc", "--noprofile"],
        env={**of.env, **COLOURS, **env},
        cwd=of.home,
        encoding="utf-8",
        # Ctrl-C may truncate an image inside a character. This happens on the alternate screen, which is then closed.
        codec_errors="replace",
        timeout=HANG_S,
        dimensions=(36, 120),
    )
    made.sendline("PS1=ready''; echo $$; stty -a > before")
    made.expect("ready")
    return made


def hold(terminal: pexpect.spawn, key: str, words: str) -> None:
    """Repeat a key, as a terminal does while somebody holds it, until the words appear.

    On a busy machine, the view may not draw a frame in the time for which a single key counts.
    """
    deadline_s = time.monotonic() + HANG_S
    terminal.send(key)
    while terminal.expect([words, pexpect.TIMEOUT], timeout=0.1) != 0:
        assert time.monotonic() < deadline_s, f"{words} does not appear"
        terminal.send(key)


def see_it_restored(terminal: pexpect.spawn, of: World) -> None:
    # Expect that the alternate screen is closed, and that the cursor is visible again.
    terminal.expect(re.escape("\x1b[?1049l"))
    terminal.expect("ready")
    terminal.sendline("stty -a > after; exit")
    terminal.expect(pexpect.EOF)
    terminal.close()
    assert (of.home / "after").read_text() == (of.home / "before").read_text()


def test_the_turtle_is_drawn_and_driven_and_the_terminal_left_as_it_was(system: World) -> None:
    terminal = shell(system)
    terminal.sendline(VIEW)
    terminal.expect("live")
    terminal.expect(SEA)
    # The simulator's messages do not appear inside the canvas.
    terminal.expect("Spawning turtle")
    terminal.expect(r"x +5\.54 m")
    terminal.expect("/turtle1/pose")
    hold(terminal, UP, r"linear\.x +2\.00 m/s")
    terminal.expect(r"x +(?!5\.54)\d\.\d\d m")
    # The key no longer repeats, so it was released.
    terminal.expect(r"linear\.x +0\.00 m/s")
    terminal.send(" ")
    terminal.expect("paused")
    terminal.send(" ")
    terminal.expect("live")
    terminal.send("z")
    terminal.expect(r"x +5\.54 m")
    terminal.sendintr()
    see_it_restored(terminal, system)


@pytest.mark.parametrize("how", ["q", pytest.param("killed", marks=pytest.mark.exhaustive)])
def test_it_ends_and_leaves_the_terminal_as_it_was(system: World, how: str) -> None:
    terminal = shell(system)
    terminal.sendline(VIEW)
    terminal.expect("Q quit")
    terminal.expect(r"x +5\.54 m")
    if how == "q":
        terminal.send("q")
    else:
        # Kill only the view. Its simulator restores the terminal.
        done = system.run("pkill -KILL -f 'grader.view terminal'")
        assert done.code == 0
        terminal.expect("ready")
        terminal.sendline("stty -a > after; exit")
        terminal.expect(pexpect.EOF)
        assert (system.home / "after").read_text() == (system.home / "before").read_text()
        return
    see_it_restored(terminal, system)


def test_two_turtlesims_with_the_same_name_are_reported_in_both_terminals(system: World) -> None:
    terminals = []
    for _ in range(2):
        terminals.append(shell(system))
        terminals[-1].sendline(OUR_TURTLESIM)
        terminals[-1].expect("Spawning turtle")
    for terminal in terminals:
        terminal.expect("Another node in this ROS domain has the name /turtlesim.")
        assert "Another" not in terminal.before
    for terminal in terminals:
        terminal.sendintr()
        terminal.expect("ready")
        terminal.close()


@pytest.mark.parametrize("stdin", ["", "echo | "])
def test_it_says_that_it_needs_a_terminal(system: World, stdin: str) -> None:
    done = system.run(f"{stdin}{VIEW}")
    assert done.code == 2
    assert "standard input or standard output is not a terminal" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_terminal_without_colours_is_reported(system: World) -> None:
    terminal = shell(system, TERM="dumb", COLORTERM="")
    terminal.sendline(f"{VIEW}; echo code=$?")
    terminal.expect(r"this terminal \(TERM=dumb\) has none")
    terminal.expect("code=2")
    terminal.close()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("--view window", "has no argument window" if REAL_TURTLESIM else "invalid choice: 'window'"),
        ("--port 8000", "--port needs --view"),
        ("--view --port 70000", "0 to 65535"),
    ],
)
def test_wrong_use_is_reported(system: World, arguments: str, said: str) -> None:
    done = system.run(f"{OUR_TURTLESIM} {arguments}")
    assert done.code == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr
