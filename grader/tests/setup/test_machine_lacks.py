"""The messages about the programs that a machine lacks."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from grader.common.package_managers import MANAGERS, Need
from grader.setup import machine
from grader.setup.machine import Python, SourcedRos

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

SYSTEMS = Python("/usr/bin/python3.11", (3, 11, 2), cpython=True, venv=True, headers=True)
APT = MANAGERS[0]
JAZZY = SourcedRos("/opt/ros/jazzy", (3, 12), turtlesim=False)


def test_names_the_packages_of_missing_programs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "SYSTEM_PATH", ())
    assert [need.package for need in machine.missing_tools(str(tmp_path), None)] == [
        "bubblewrap",
        "util-linux",
        "g++",
        "cmake",
        "make",
    ]
    (tmp_path / "cmake").touch(mode=0o755)
    assert "cmake" not in [need.package for need in machine.missing_tools(str(tmp_path), None)]


def test_an_installed_turtlesim_needs_no_compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "SYSTEM_PATH", ())
    needs = machine.missing_tools(str(tmp_path), JAZZY._replace(turtlesim=True))
    assert [need.package for need in needs] == ["bubblewrap", "util-linux"]


def test_any_browser_will_do_for_the_tests(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "SYSTEM_PATH", ())
    packages = [need.package for need in machine.missing_of_tests(str(tmp_path))]
    assert packages == ["chromium-headless-shell", "shellcheck", "zsh"]
    (tmp_path / "google-chrome").touch(mode=0o755)
    assert [need.package for need in machine.missing_of_tests(str(tmp_path))] == ["shellcheck", "zsh"]


def test_names_the_packages_of_the_python_that_lacks_them() -> None:
    default = SYSTEMS._replace(path=os.path.realpath("/usr/bin/python3"), venv=False, headers=False)
    other = SYSTEMS._replace(path="/usr/bin/python3.13-other", version=(3, 13, 1), venv=False, headers=False)
    assert [need.package for need in machine.missing_of_python(default)] == ["python3-venv", "python3-dev"]
    assert [need.package for need in machine.missing_of_python(other)] == ["python3.13-venv", "python3.13-dev"]
    assert machine.missing_of_python(SYSTEMS) == []


def test_a_newer_python_beside_one_that_is_too_old_is_requested_by_its_name() -> None:
    needs = machine.missing_of_python(None, newer="python3.12")
    assert [need.package for need in needs] == ["python3.12", "python3.12-venv", "python3.12-dev"]
    wanted = machine.missing_of_python(None, (3, 10), newer="python3.12")
    assert [need.package for need in wanted] == ["python3.10", "python3.10-venv", "python3.10-dev"]


def test_one_message_with_one_command() -> None:
    needs = [Need("a compiler", "g++"), Need("setpriv", "util-linux"), Need("prlimit", "util-linux")]
    assert machine.lack_message(needs, APT, root=False).splitlines() == [
        "The course needs the following, which this system does not have:",
        "  - a compiler",
        "  - setpriv",
        "  - prlimit",
        "Install them with this command, then run make again:",
        "",
        "    sudo apt-get update && sudo apt-get install -y g++ util-linux",
    ]
    assert "\n    apt-get update && apt-get install -y g++ util-linux" in machine.lack_message(needs, APT, root=True)


def test_why_it_was_not_installed_is_reported() -> None:
    message = machine.lack_message([Need("a compiler", "g++")], APT, root=False, why="sudo is not here")
    assert "  - a compiler\nThe missing part was not installed: sudo is not here.\nInstall it with" in message


def test_without_apt_the_things_are_named_all_the_same() -> None:
    message = machine.lack_message([Need("a compiler", "g++")], None, root=False)
    assert "a compiler" in message
    assert "apt-get" not in message


def test_no_python_at_all_names_python_and_an_alternative() -> None:
    message = machine.lack_message(machine.missing_of_python(None), APT, root=False)
    assert "CPython 3.10 to 3.14" in message
    assert "apt-get install -y python3 python3-venv python3-dev" in message
    assert "docker run" in message
    assert "python3.12 python3.12-venv python3.12-dev" in machine.lack_message(
        machine.missing_of_python(None, (3, 12)), APT, root=False
    )
