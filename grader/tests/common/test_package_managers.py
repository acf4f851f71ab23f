from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.common import package_managers
from grader.common.package_managers import MANAGERS, Need
from grader.tests.stand_ins import StandIns

if TYPE_CHECKING:
    from pathlib import Path

BY_NAME = {manager.program: manager for manager in MANAGERS}
PROGRAMS = "g++ cmake make util-linux bubblewrap chromium shellcheck"
PYTHONS = "python3 python3-venv python3-dev python3.12 python3.12-venv python3.12-dev"
ALL = [Need(name, name) for name in f"{PROGRAMS} {PYTHONS}".split()]
RED_HATS = "gcc-c++ cmake make util-linux bubblewrap chromium ShellCheck"


@pytest.fixture(autouse=True)
def _nothing_of_this_system(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(package_managers, "SYSTEM_PATH", ())
    monkeypatch.setattr(package_managers, "OS_RELEASE", tmp_path / "os-release")
    monkeypatch.setattr(package_managers, "PACMAN_LISTS", tmp_path / "sync")


@pytest.mark.parametrize(
    ("program", "names"),
    [
        ("apt-get", f"{PROGRAMS} {PYTHONS}"),
        ("dnf", f"{RED_HATS} python3 python3-devel python3.12 python3.12-devel"),
        ("pacman", "gcc cmake make util-linux bubblewrap chromium shellcheck python"),
        ("zypper", f"{RED_HATS} python3 python3-devel python312 python312-devel"),
    ],
)
def test_each_manager_has_names_of_its_own(program: str, names: str) -> None:
    assert " ".join(BY_NAME[program].packages(ALL)) == names


@pytest.mark.parametrize(
    ("program", "line"),
    [
        ("apt-get", "sudo apt-get update && sudo apt-get install -y g++ python3-dev"),
        ("dnf", "sudo dnf install -y gcc-c++ python3-devel"),
        ("pacman", "sudo pacman -Sy --needed --noconfirm gcc python"),
        ("zypper", "sudo zypper --non-interactive install gcc-c++ python3-devel"),
    ],
)
def test_each_manager_has_its_command_line(program: str, line: str) -> None:
    needs = [Need("a compiler", "g++"), Need("headers", "python3-dev")]
    assert package_managers.command(BY_NAME[program], needs, root=False) == line
    assert package_managers.command(BY_NAME[program], needs, root=True) == line.replace("sudo ", "")


def test_pacman_keeps_lists_that_it_has(tmp_path: Path) -> None:
    (tmp_path / "sync").mkdir()
    (tmp_path / "sync/core.db").touch()
    line = package_managers.command(BY_NAME["pacman"], [Need("cmake", "cmake")], root=True)
    assert line == "pacman -S --needed --noconfirm cmake"


def test_without_a_manager_debians_names_are_reported() -> None:
    line = package_managers.command(None, [Need("a compiler", "g++"), Need("headers", "python3-dev")], root=False)
    assert line == "your package manager (Debian's names: g++, python3-dev)"


@pytest.mark.parametrize("program", list(BY_NAME))
def test_the_manager_on_the_path_is_taken(tmp_path: Path, program: str) -> None:
    stand_ins = StandIns(tmp_path / "bin")
    assert package_managers.find_manager(stand_ins.path) is None
    stand_ins.add(program)
    assert package_managers.find_manager(stand_ins.path) == BY_NAME[program]


@pytest.mark.parametrize(
    ("release", "program"),
    [
        ('NAME="Fedora Linux"\nID=fedora\n', "dnf"),
        ('ID="rocky"\nID_LIKE="rhel centos fedora"\n', "dnf"),
        ('ID="opensuse-leap"\nID_LIKE="suse opensuse"\n', "zypper"),
        ("ID=ubuntu\nID_LIKE=debian\n", "apt-get"),
        ("ID=manjaro\nID_LIKE=arch\n", "pacman"),
        ("", "apt-get"),
    ],
)
def test_of_several_managers_the_systems_own_is_taken(tmp_path: Path, release: str, program: str) -> None:
    stand_ins = StandIns(tmp_path / "bin")
    for name in BY_NAME:
        stand_ins.add(name)
    (tmp_path / "os-release").write_text(release)
    found = package_managers.find_manager(stand_ins.path)
    assert found is not None
    assert found.program == program
