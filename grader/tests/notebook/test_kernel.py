from __future__ import annotations

import os
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from grader.errors import MachineError
from grader.notebook import kernel, simulator

if TYPE_CHECKING:
    from pathlib import Path


class StartedError(Exception):
    """Stores the command line. The real function would replace this process by another program."""


@pytest.fixture
def started(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """Return the commands that are started. The ROS 2 of the set-up is in `tmp_path`/jazzy and is not sourced."""
    commands: list[list[str]] = []

    def execve(_program: str, argv: list[str], _env: dict[str, str]) -> None:
        commands.append(argv)
        raise StartedError

    def no_ros() -> dict[str, str]:
        message = "This course was set up for another ROS 2."
        raise MachineError(message)

    (tmp_path / "jazzy").mkdir()
    (tmp_path / "jazzy/setup.bash").write_text("export ROS_DISTRO=jazzy-of-the-set-up\n")
    monkeypatch.setattr(kernel, "made_for", lambda _prefix: str(tmp_path / "jazzy"))
    monkeypatch.setattr(simulator, "environment", no_ros)
    monkeypatch.setattr(os, "execve", execve)
    monkeypatch.setattr(sys, "argv", ["kernel", "-f", "connection file"])
    return commands


def test_the_ros_of_the_set_up_is_sourced_if_jupyter_was_started_without_it(started: list[list[str]]) -> None:
    with pytest.raises(StartedError):
        kernel.main()
    (argv,) = started
    *shell, _python, _isolated, _m, module, option, file = argv
    assert (module, option, file) == ("grader.notebook.kernel", "-f", "connection file")
    done = subprocess.run([*shell, "sh", "-c", "echo $ROS_DISTRO"], capture_output=True, text=True, check=True)
    assert done.stdout == "jazzy-of-the-set-up\n"


def test_a_ros_that_cannot_be_sourced_leaves_a_plain_kernel_with_the_reason(
    started: list[list[str]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "jazzy/setup.bash").unlink()
    with pytest.raises(StartedError):
        kernel.main()
    assert "ipykernel_launcher" in started[0]
    assert "set up for another ROS 2" in capsys.readouterr().err


def test_the_kernel_starts_again_only_once(started: list[list[str]], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("_GRADER_KERNEL_STARTED_AGAIN", "1")
    with pytest.raises(StartedError):
        kernel.main()
    assert "ipykernel_launcher" in started[0]


def test_a_full_disk_is_named_when_the_kernel_is_installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(source: str, target: str, **_: object) -> None:
        raise shutil.Error([(source, f"{target}/kernel.json", "[Errno 28] No space left on device")])

    monkeypatch.setattr(shutil, "copytree", full)
    with pytest.raises(
        MachineError, match=r"^The kernel could not be installed in .*kernel\.json: No space left on device\.$"
    ):
        kernel.install(tmp_path)
