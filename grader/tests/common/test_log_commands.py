"""Output that no continuous integration system executes, whether it arrives at once or in pieces."""

from __future__ import annotations

import io
import subprocess
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.common.interpreter import interpreter
from grader.common.log_commands import LogText, without_commands
from grader.tests.case import copy_solution
from grader.tests.report.readers import commands

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

STEP = "03-circle-publisher"
PIECES = (
    *("::", ":", "#", "##[error]", "##vso[task.x]", "##TeamCity[x]", "vso[", "["),
    *(" ", "\t", "\n", "\r", "\xa0", "error", "x"),
)
"""Texts that form commands together."""


def written(pieces: Sequence[str]) -> str:
    kept = io.BytesIO()
    stream = LogText(kept, "utf-8", newline="")
    for piece in pieces:
        assert stream.write(piece) == len(piece)
    stream.flush()
    return kept.getvalue().decode()


def assert_without_commands(log: str) -> None:
    assert commands(log) == []
    assert not [line for line in log.replace("\r", "\n").split("\n") if line.strip().startswith("::")]
    assert not [marker for marker in ("##[", "##vso[", "##teamcity[") if marker in log.lower()]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("::error::x", ": :error::x"),
        ("a\n  ::error::x\r::y", "a\n  : :error::x\r: :y"),
        ("x ##[error] ##vso[task.x] ##TeamCity[x]", "x # #[error] # #vso[task.x] # #TeamCity[x]"),
        ("test_a.py::test_b: ### a heading, 1 ## 2", "test_a.py::test_b: ### a heading, 1 ## 2"),
    ],
)
def test_only_commands_are_changed(text: str, expected: str) -> None:
    assert without_commands(text) == expected
    assert written([text]) == expected


@given(st.lists(st.sampled_from(PIECES), max_size=12))
def test_commands_in_pieces_are_no_commands(pieces: list[str]) -> None:
    log = written(pieces)
    assert_without_commands(log)
    assert "".join(log.split()) == "".join("".join(pieces).split())


def test_the_end_of_a_long_line_is_not_its_beginning() -> None:
    pieces = ["The test is test_a.py", " " * 20, "::test_b", " ::", "\n"]
    assert written(pieces) == "".join(pieces)


def test_many_empty_lines_take_no_time() -> None:
    assert len(without_commands("\n" * 200_000)) == 200_000
    assert len(without_commands(" " * 200_000)) == 200_000


def test_check_prints_a_students_text_without_commands(tmp_path: Path) -> None:
    """The name of the folder and the message of setup.py are commands."""
    package = tmp_path / "::error::owned ##vso[task.x]"
    copy_solution(STEP, package)
    setup = package / "setup.py"
    setup.write_text("raise SystemExit('::error::owned ##vso[task.y] ##[error]z')\n", "utf-8")
    start = interpreter("-m", "grader.cli", "check", str(package), "--exercise", STEP)
    done = subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=False, cwd=tmp_path)
    log = done.stdout + done.stderr
    assert "vso[task" in log, log
    assert_without_commands(log)
