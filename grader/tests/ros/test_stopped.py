"""Programs that Ctrl-Z has stopped are named if no node is found."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from grader.ros.failure import did_you_mean
from grader.ros.stopped import stopped_programs
from grader.tests.waiting import until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

DOMAIN = "a domain of this test"
SLEEPS = "import time; time.sleep(600)"


@contextmanager
def stopped(argv: list[str]) -> Iterator[int]:
    """Start a program, stop it, and return its process id."""
    with subprocess.Popen(argv, env={**os.environ, "ROS_DOMAIN_ID": DOMAIN}) as process:
        try:
            process.send_signal(signal.SIGSTOP)
            os.waitid(os.P_PID, process.pid, os.WSTOPPED)
            yield process.pid
        finally:
            process.kill()


@pytest.fixture
def node(tmp_path: Path) -> Path:
    """Write a program as colcon installs it, and return its path."""
    script = tmp_path / "install/lib/my_robot_controller/draw_circle"
    script.parent.mkdir(parents=True)
    script.write_text(SLEEPS)
    return script


def test_a_stopped_node_and_a_stopped_turtlesim_are_named(node: Path) -> None:
    with stopped([sys.executable, str(node)]) as pid:
        assert stopped_programs(DOMAIN) == [("draw_circle", pid)]
        os.kill(pid, signal.SIGCONT)
        until(lambda: stopped_programs(DOMAIN) == [])
    with stopped([sys.executable, "-c", SLEEPS, "grader.view.turtlesim_node", "--view"]) as pid:
        assert stopped_programs(DOMAIN) == [("turtlesim_node", pid)]
        assert stopped_programs("7") == []


def test_a_stopped_program_that_only_shows_a_node_is_not_a_node(node: Path) -> None:
    with stopped(["tail", "-f", str(node)]):
        assert stopped_programs(DOMAIN) == []


def test_no_node_names_the_stopped_program(node: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", DOMAIN)
    assert "Start one in another terminal, for example: grader sim" in did_you_mean("/a", [], nodes=())
    with stopped([sys.executable, str(node)]) as pid:
        said = did_you_mean("/a", [], nodes=())
    assert f"draw_circle (process {pid}) is stopped, as Ctrl-Z does. To continue it, type fg in its terminal." in said
    assert "grader sim" not in said
