"""An executable that is installed but cannot be run."""

from __future__ import annotations

import signal
from argparse import Namespace
from typing import TYPE_CHECKING

import pytest

from grader.ros.failure import Ros2Error
from grader.ros2 import run
from grader.ros2.child import run_child
from grader.tests.pretended import mounted_noexec

if TYPE_CHECKING:
    from pathlib import Path


def test_a_workspace_from_which_no_program_runs_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    index, installed = tmp_path / "share/ament_index/resource_index/packages", tmp_path / "lib/my_robot_controller"
    for folder in (index, installed):
        folder.mkdir(parents=True)
    (index / "my_robot_controller").touch()
    (installed / "draw_circle").touch(mode=0o644)  # noexec has the same effect
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    args = Namespace(package_name="my_robot_controller", executable_name="draw_circle", prefix=None, argv=[])
    with pytest.raises(Ros2Error, match="Executables of my_robot_controller: none"):
        run.run(args)
    mounted_noexec(monkeypatch, tmp_path)
    with pytest.raises(Ros2Error, match=r"is mounted with the option noexec.* move your workspace"):
        run.run(args)


def test_executables_in_the_folder_of_another_name_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    prefix = tmp_path / "install/my_robot_controller"
    index, installed = prefix / "share/ament_index/resource_index/packages", prefix / "lib/robot_controller"
    for folder in (index, installed, prefix / "lib/python3.11/site-packages"):
        folder.mkdir(parents=True)
    (index / "my_robot_controller").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    args = Namespace(package_name="my_robot_controller", executable_name="draw_circle", prefix=None, argv=[])
    with pytest.raises(Ros2Error, match="none; entry_points"):
        run.run(args)
    (installed / "draw_circle").touch(mode=0o755)
    named = "none in lib/my_robot_controller, but in lib/robot_controller"
    with pytest.raises(Ros2Error, match=named):
        run.run(args)
    prefix.rename(tmp_path / "merged")  # here, lib/robot_controller could belong to another package
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "merged"))
    with pytest.raises(Ros2Error, match="none; entry_points"):
        run.run(args)


def test_a_missing_interpreter_is_not_reported_as_the_prefix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    index, installed = tmp_path / "share/ament_index/resource_index/packages", tmp_path / "lib/my_robot_controller"
    for folder in (index, installed):
        folder.mkdir(parents=True)
    (index / "my_robot_controller").touch()
    (installed / "draw_circle").write_text(f'#!"{tmp_path}/no such/python3"\n')
    (installed / "draw_circle").chmod(0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    args = Namespace(package_name="my_robot_controller", executable_name="draw_circle", prefix=None, argv=[])
    with pytest.raises(Ros2Error, match=r"could not be started: .* Is the interpreter"):
        run.run(args)
    args.prefix = "no-such-command"
    with pytest.raises(Ros2Error, match="the command 'no-such-command' was not found"):
        run.run(args)


def test_signals_are_not_blocked_after_a_program_that_cannot_be_started() -> None:
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    with pytest.raises(Ros2Error, match="/no/such/program could not be started: No such file"):
        run_child(["/no/such/program"])
    assert signal.pthread_sigmask(signal.SIG_BLOCK, ()) == before
