"""Output to a terminal, which must not contain control sequences of other programs."""

from __future__ import annotations

import os
import pty
import subprocess

import pytest

from grader.common.interpreter import interpreter
from grader.common.terminal_text import without_control

LINK = "\x1b]8;;http://evil.example\x1b\\here\x1b]8;;\x1b\\"
CLIPBOARD = "\x1b]52;c;ZXZpbA==\x07"
HIDDEN = "\x1b[1A\x1b[2K\x1b[8m"
PRINTS = "import sys; from grader.common.plain_output import protect_terminal; protect_terminal(); print(sys.argv[1])"


@pytest.mark.parametrize("text", [LINK, CLIPBOARD, HIDDEN, "\x9b2K", "forged\rline", "\b\b", "\x7f", "\0"])
def test_no_control_character_is_left(text: str) -> None:
    assert not {"\x1b", "\x9b", "\r", "\b", "\x07", "\x7f", "\0"} & set(without_control(text))


@pytest.mark.parametrize("character", "\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
def test_no_text_is_turned_around(character: str) -> None:
    assert without_control(f"/{character}x") == "/?x"


@pytest.mark.parametrize("text", ["/turtle1\n", "\tmin: 0.1\n", "\x1b[33mwarning\x1b[0m", "naïve 🐢 \u200d"])
def test_other_text_stays_as_it_is(text: str) -> None:
    assert without_control(text) == text


def test_a_terminal_gets_no_control_sequence_and_a_pipe_gets_the_text_as_it_is() -> None:
    start = interpreter("-c", PRINTS, CLIPBOARD)
    above, below = pty.openpty()
    with os.fdopen(above, "rb", buffering=0) as terminal:
        with os.fdopen(below, "wb") as output:
            subprocess.run(start.argv, env=start.env, stdout=output, check=True)
        assert terminal.read(1000) == b"?]52;c;ZXZpbA==?\r\n"
    piped = subprocess.run(start.argv, env=start.env, stdout=subprocess.PIPE, check=True)
    assert piped.stdout.decode() == f"{CLIPBOARD}\n"
