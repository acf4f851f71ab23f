"""Ctrl-C ends a program of `ros2 run` quietly, however early it is pressed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from grader.common.interpreter import interpreter
from grader.ros import underlay
from grader.ros.installation import find_ros
from grader.tests.both_worlds import of_our_ros2, of_our_turtlesim, python_path
from grader.tests.setup.test_commands import with_block_signal

INTERRUPTED = "import os, signal\nos.kill(os.getpid(), signal.SIGINT)\n"
BEFORE_THE_PROGRAM_EXISTS = """
import signal, subprocess
from grader.ros2.child import run_child


def popen(*args, **options):
    signal.raise_signal(signal.SIGINT)
    return real(*args, **options)


real, subprocess.Popen = subprocess.Popen, popen
print(run_child(["sleep", "100"]))
"""


@with_block_signal
@of_our_turtlesim
@pytest.mark.parametrize("program", ["turtlesim_node", "turtle_teleop_key", "draw_square", "mimic"])
def test_while_python_starts(tmp_path: Path, program: str) -> None:
    (tmp_path / "sitecustomize.py").write_text(INTERRUPTED)
    prefix = underlay.with_turtlesim(find_ros()).underlay
    assert prefix is not None
    done = subprocess.run(
        [str(prefix / "lib/turtlesim" / program)],
        env={**os.environ, "PYTHONPATH": python_path(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, "", "")


@with_block_signal
@of_our_ros2
@pytest.mark.parametrize(
    ("command", "restarted", "code"),
    [
        (["grader", "sim"], "'grader.view.turtlesim_node' in sys.orig_argv", -signal.SIGINT),
        (["ros2", "topic", "list"], "'_GRADER_ROS2_STARTED_AGAIN' in os.environ", 2),
    ],
)
def test_while_a_command_is_replaced_by_another(tmp_path: Path, command: list[str], restarted: str, code: int) -> None:
    interrupts = "os.kill(os.getpid(), signal.SIGINT); print('sent', flush=True)"
    (tmp_path / "sitecustomize.py").write_text(f"import os, signal, sys\nif {restarted}:\n    {interrupts}\n")
    done = subprocess.run(
        [str(Path(sys.executable).with_name(command[0])), *command[1:]],
        env={**os.environ, "PYTHONPATH": python_path(tmp_path), "AMENT_PREFIX_PATH": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout) == (code, "sent\n")
    assert "Traceback" not in done.stderr


def test_before_the_program_exists() -> None:
    start = interpreter("-c", BEFORE_THE_PROGRAM_EXISTS, python=sys.executable, searches=True)
    done = subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "[ros2run]: Interrupt\n-2\n", "")
