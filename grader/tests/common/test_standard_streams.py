"""Commands whose standard streams are closed, or whose encoding does not have ✓ and →."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from grader.common import xdg
from grader.common.standard_streams import has_signs
from grader.tests.both_worlds import SOURCED_ENV, of_our_ros2

BIN = Path(sys.executable).parent
SOLUTION = Path(__file__).parents[3] / "solutions" / "03-circle-publisher" / "my_robot_controller"
ASCII_LOCALE = {"LC_ALL": "POSIX", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
COMMANDS = ("grader --help", "grader status", "grader env", pytest.param("ros2 pkg list", marks=of_our_ros2))
ROS2_HELP = pytest.param("ros2 --help", marks=of_our_ros2)


def run(line: str, home: Path, **env: str) -> subprocess.CompletedProcess[str]:
    # The cache contains turtlesim's messages, which would be built again.
    places = {"HOME": str(home), "PATH": f"{BIN}:/usr/bin:/bin", "XDG_CACHE_HOME": str(xdg.cache().parent)}
    env = {**SOURCED_ENV, **places, **env}
    return subprocess.run(["sh", "-c", line], env=env, capture_output=True, text=True, check=False)


def errors(done: subprocess.CompletedProcess[str]) -> list[str]:
    """Return the lines of standard error, without the line about a sourced ROS 2 that `grader env` prints."""
    return [line for line in done.stderr.splitlines() if not line.startswith("Using the ROS 2 that is sourced")]


@pytest.mark.parametrize("closed", ["<&-", ">&-", ">&- <&-"])
@pytest.mark.parametrize("command", COMMANDS)
def test_a_closed_stream_is_no_error(tmp_path: Path, command: str, closed: str) -> None:
    done = run(f"{command} {closed}", tmp_path)
    assert (done.returncode, "rror" in done.stderr) == (0, False), done.stderr


@pytest.mark.parametrize("command", [*COMMANDS, "grader hint 01", ROS2_HELP])
def test_a_reader_that_has_exited_is_no_error(tmp_path: Path, command: str) -> None:
    done = run(f"{{ sleep 0.01; {command}; echo $? >&3; }} 3>&2 | true", tmp_path)
    assert errors(done) == ["0" if command.startswith("ros2") else "1"]


def test_an_error_is_reported_although_the_reader_has_exited(tmp_path: Path) -> None:
    done = run("{ sleep 0.01; grader env; echo $? >&3; } 3>&2 | true", tmp_path, ROS_DOMAIN_ID="999")
    assert [line[:13] for line in done.stderr.splitlines()] == ["grader: ROS_D", "2"]


@pytest.mark.parametrize("command", [*COMMANDS, "grader hint 01", ROS2_HELP])
def test_output_that_cannot_be_written_is_one_sentence(tmp_path: Path, command: str) -> None:
    done = run(f"{command} > /dev/full", tmp_path)
    assert (done.returncode, len(errors(done))) == (3, 1)
    assert "The disk is full" in errors(done)[0]


@pytest.mark.parametrize("command", [*COMMANDS, "grader hint 01"])
def test_messages_that_cannot_be_written_are_no_error(tmp_path: Path, command: str) -> None:
    done = run(f"{command} 2> /dev/full", tmp_path)
    assert (done.returncode, done.stdout != "") == (0, True)


def test_a_report_arrives_although_the_progress_cannot_be_written(tmp_path: Path) -> None:
    line = f"grader check '{SOLUTION}'"
    assert run(f"{line} 2> /dev/full", tmp_path).stdout == run(line, tmp_path).stdout != ""


def test_no_file_takes_the_place_of_a_closed_standard_output(tmp_path: Path) -> None:
    code = (
        "import os, subprocess, sys; from grader.common.standard_streams import make_usable; make_usable(); "
        f"file = open({str(tmp_path / 'file')!r}, 'w'); print('lost'); subprocess.call(['echo', 'lost too'])"
    )
    done = run(f'"{sys.executable}" -c "{code}" >&-', tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "file").read_text() == ""


@pytest.mark.parametrize("env", [{"PYTHONIOENCODING": "ascii"}, ASCII_LOCALE])
def test_the_status_has_signs_of_its_own_without_unicode(tmp_path: Path, env: dict[str, str]) -> None:
    done = run("grader status", tmp_path, **env)
    assert (done.returncode, done.stderr) == (0, "")
    assert "-  01-first-node" in done.stdout


def test_characters_that_an_encoding_lacks_are_replaced(tmp_path: Path) -> None:
    folder = tmp_path / "Übung"
    done = run(f"grader status --workspace '{folder}'", tmp_path, PYTHONIOENCODING="ascii")
    assert (done.returncode, done.stderr) == (0, "")
    assert "?bung" in done.stdout


def test_a_name_that_is_not_utf_8_is_printed_as_it_is(tmp_path: Path) -> None:
    """In a locale such as en_US.UTF-8, Python would raise an error."""
    line = "grader status --workspace \"$(printf '/tmp/\\374bung')\" | od -c | grep -o '374 *b'"
    done = run(line, tmp_path, PYTHONIOENCODING="utf-8:strict")
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize(("encoding", "has"), [("utf-8", True), ("UTF-16", True), ("ascii", False), ("latin-1", False)])
def test_only_unicode_has_signs(encoding: str, has: bool) -> None:
    assert has_signs(encoding) is has
