"""Messages on terminals with few columns."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import struct
import subprocess
import sys
import termios
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.common import xdg
from grader.common.terminal_text import columns, example, hanging, wrapped
from grader.tests.both_worlds import REAL_ROS2

if TYPE_CHECKING:
    from collections.abc import Sequence

BIN = Path(sys.executable).parent
ERRORS = (
    "grader check /nowhere",
    "grader start 99",
    "grader solution 03",
    "grader hint 03 q",
    "grader regrade /",
    "grader chekc",
    *(() if REAL_ROS2 else ("ros2 topic ehco", "ros2 bag info /nowhere")),
)


def on_terminal(line: str, width: int, home: Path, *, arguments: Sequence[str] = (), **settings: str) -> str:
    """Return what a terminal with this number of columns would get from a command of the shell with these arguments."""
    above, below = pty.openpty()
    fcntl.ioctl(below, termios.TIOCSWINSZ, struct.pack("HHHH", 24, width, 0, 0))
    places = {"HOME": str(home), "PATH": f"{BIN}:/usr/bin:/bin", "XDG_CACHE_HOME": str(xdg.cache().parent)}
    env, argv = {**places, "TERM": "xterm", **settings}, ["sh", "-c", line, *arguments]
    with subprocess.Popen(argv, env=env, stdin=below, stdout=below, stderr=below):
        os.close(below)
        shown = b""
        while True:
            try:
                read = os.read(above, 65536)
            except OSError:
                break
            shown += read
    os.close(above)
    return shown.decode().replace("\r\n", "\n")


def plain(shown: str) -> str:
    """Return the text without colours."""
    return re.sub(r"\x1b\[[0-9;]*m", "", shown)


def broken_words(shown: str, width: int) -> list[str]:
    """Return the lines that a terminal would break inside a word, although the word fits into a line."""
    return [line for line in shown.splitlines() if len(line) > width and max(map(len, line.split())) < width]


@pytest.mark.parametrize("line", ERRORS)
def test_errors_are_broken_between_words(tmp_path: Path, line: str) -> None:
    shown = plain(on_terminal(line, 40, tmp_path))
    assert "rror" in shown or shown.startswith(("grader: ", "Could not", "ros2"))
    assert broken_words(shown, 40) == []


@pytest.mark.parametrize(("settings", "coloured"), [({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False)])
def test_errors_are_red_unless_colours_are_unwanted(
    tmp_path: Path, settings: dict[str, str], *, coloured: bool
) -> None:
    assert ("\x1b[" in on_terminal("grader start 99", 80, tmp_path, **settings)) is coloured


def test_paragraphs_are_wrapped_and_indented_lines_stay() -> None:
    text = "Install the programs, then run make again:\n\n    apt-get install bubblewrap cmake\nDone."
    assert wrapped(text, 20) == (
        "Install the\nprograms, then run\nmake again:\n\n    apt-get install bubblewrap cmake\nDone."
    )
    assert wrapped(text, None) == text


@pytest.mark.parametrize(
    "command",
    [
        "`grader hint 03-circle-publisher`",
        "source '/home/a b/.venv/setup.bash'",
        "cd ~/x && make demo",
        "sudo apt-get install -y cmake",
    ],
)
def test_a_command_is_not_wrapped(command: str) -> None:
    shown = wrapped(f"This is what you can type now: {command}, and then go on.", 20)
    assert f"{command}," in shown.split("\n")
    assert wrapped("the source of a node", 10) == "the source\nof a node"


def test_a_hanging_indent() -> None:
    assert hanging("seen and expected", 14, "ok  ", "      ") == "ok  seen and\n      expected"
    assert hanging("seen and expected", None, "ok  ", "      ") == "ok  seen and expected"


def test_an_example_stays_one_command() -> None:
    assert example("grader status", 40) == ["  grader status"]
    command = "grader grade submitted --exercise 03-circle-publisher --out grades"
    lines = example(command, 40)
    assert lines == ["  grader grade submitted \\", "    --exercise 03-circle-publisher \\", "    --out grades"]
    assert "".join(line.removesuffix("\\") for line in lines).split() == command.split()


def test_a_pipe_has_no_columns() -> None:
    with Path("/dev/null").open("w") as file:
        assert columns(file) is None


@pytest.mark.parametrize("command", ["class-page", "regrade", "check --exercise 03 --json"])
def test_the_name_of_a_folder_in_an_error_cannot_control_the_terminal(tmp_path: Path, command: str) -> None:
    hostile = tmp_path / "\x1b]52;c;ZXZpbA==\x07\x1b[2J"
    hostile.mkdir()
    shown = plain(on_terminal(f'grader {command} "$0"', 200, tmp_path, arguments=[str(hostile)], NO_COLOR="1"))
    assert "?]52;c;ZXZpbA==??[2J" in shown
    assert not {"\x1b", "\x07"} & set(shown)
