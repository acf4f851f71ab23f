"""The installation of system packages, tested with fake package managers and a fake sudo."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from grader.common import package_managers
from grader.common.package_managers import Need
from grader.setup import provide
from grader.tests.stand_ins import StandIns

if TYPE_CHECKING:
    from pathlib import Path

CMAKE, COMPILER = Need("cmake", "cmake"), Need("a compiler", "g++")
BUBBLEWRAP, BROWSER = Need("bubblewrap", "bubblewrap", "no marks"), Need("a browser", "chromium", "no pages")
SUDO_FREE = '[ "$1" = -n ] && shift; exec "$@"'
SUDO_ASKS = '[ "$1" = -n ] && { echo "sudo: a password is required" >&2; exit 1; }; exec "$@"'
APT = "apt-get install -y -q --no-install-recommends -o DPkg::Lock::Timeout=60 -o Acquire::http::Timeout=20"


class Machine:
    """A machine on which fake programs replace the system's programs, and the messages of the set-up."""

    def __init__(self, folder: Path) -> None:
        self.stand_ins = StandIns(folder)
        self.said: list[str] = []

    def provide(self, *needs: Need, **env: str) -> str:
        # The shell is the real one.
        given = {"PATH": f"{self.stand_ins.path}:/usr/bin:/bin", **env}
        return provide.provide(needs, given, self.said.append)


@pytest.fixture
def machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Machine:
    monkeypatch.setattr(package_managers, "find_program", lambda name, _path: _in(tmp_path / "bin", name))
    monkeypatch.setattr(package_managers, "PACMAN_LISTS", tmp_path)
    monkeypatch.setattr(os, "getuid", lambda: 1000)
    monkeypatch.setenv("PATH", f"{tmp_path}/bin:/usr/bin:/bin")
    return Machine(tmp_path / "bin")


def _in(folder: Path, name: str) -> str | None:
    return str(folder / name) if (folder / name).exists() else None


def test_root_installs_at_once_and_says_so_in_one_line(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "getuid", lambda: 0)
    machine.stand_ins.add("apt-get", "echo lots of output")
    assert machine.provide(CMAKE, COMPILER) == ""
    assert machine.stand_ins.calls() == ["apt-get update -q", f"{APT} cmake g++"]
    assert machine.said == [
        "Installing the missing system packages: apt-get update && apt-get install -y cmake g++",
    ]


@pytest.mark.parametrize(
    ("program", "calls"),
    [
        ("apt-get", ["apt-get update -q", f"{APT} g++"]),
        ("dnf", ["dnf install -y -q --setopt=install_weak_deps=False gcc-c++"]),
        ("pacman", ["pacman -Sy --needed --noconfirm gcc"]),
        ("zypper", ["zypper --non-interactive install --no-recommends gcc-c++"]),
    ],
)
def test_sudo_without_a_password_installs_at_once(machine: Machine, program: str, calls: list[str]) -> None:
    machine.stand_ins.add(program)
    machine.stand_ins.add("sudo", SUDO_FREE)
    assert machine.provide(COMPILER) == ""
    assert [call for call in machine.stand_ins.calls() if not call.startswith("sudo")] == calls
    assert all(call.startswith("sudo -n ") for call in machine.stand_ins.calls() if call.startswith("sudo"))
    assert len(machine.said) == 1


def test_what_can_be_done_without_is_installed_by_itself(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "getuid", lambda: 0)
    fails = 'echo "E: Unable to locate package chromium"; exit 100'
    machine.stand_ins.add("apt-get", f'case "$*" in *chromium*) {fails};; esac')
    why = machine.provide(BROWSER, CMAKE, BUBBLEWRAP, COMPILER)
    assert machine.stand_ins.calls() == [
        "apt-get update -q",
        f"{APT} cmake g++",
        f"{APT} chromium",
        f"{APT} bubblewrap",
    ]
    assert why == "apt-get failed: E: Unable to locate package chromium"


@pytest.mark.parametrize(
    ("then", "why"),
    [
        (
            'echo "Reading lists..."; echo "E: Could not get lock /var/lib/dpkg/lock-frontend." >&2; exit 100',
            "apt-get failed: E: Could not get lock /var/lib/dpkg/lock-frontend",
        ),
        (
            """[ $1 = update ] && echo "W: Failed to fetch: Could not resolve host" && exit 0
            echo "E: Unable to locate package cmake"; exit 100""",
            "apt-get failed: W: Failed to fetch: Could not resolve host; E: Unable to locate package cmake",
        ),
        ("echo only words; exit 1", "apt-get failed: only words"),
        ("exit 1", "apt-get failed: no reason given"),
    ],
)
def test_a_failure_is_reported_in_the_managers_own_words(
    machine: Machine, monkeypatch: pytest.MonkeyPatch, then: str, why: str
) -> None:
    monkeypatch.setattr(os, "getuid", lambda: 0)
    machine.stand_ins.add("apt-get", then)
    assert machine.provide(CMAKE) == why


def test_nothing_is_touched_where_that_was_requested(machine: Machine) -> None:
    machine.stand_ins.add("apt-get")
    machine.stand_ins.add("sudo", SUDO_FREE)
    assert "INSTALL_SYSTEM=0" in machine.provide(CMAKE, INSTALL_SYSTEM="0")
    assert (machine.stand_ins.calls(), machine.said) == ([], [])


def test_without_a_manager_or_sudo_nothing_is_tried(machine: Machine) -> None:
    assert machine.provide(CMAKE) == "the set-up does not support the package manager of this system"
    machine.stand_ins.add("apt-get")
    assert machine.provide(CMAKE) == "only root can install programs, and sudo is not installed"
    assert (machine.stand_ins.calls(), machine.said) == ([], [])


def test_where_there_is_no_terminal_nobody_is_prompted_for_a_password(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine.stand_ins.add("apt-get")
    machine.stand_ins.add("sudo", SUDO_ASKS)
    monkeypatch.setattr(sys, "stdin", open(os.devnull))  # noqa: SIM115, PTH123
    assert "sudo needs a terminal to ask for a password" in machine.provide(CMAKE)
    assert machine.stand_ins.calls() == ["sudo -n true"]


def test_at_a_terminal_the_command_is_shown_and_the_password_requested_once(tmp_path: Path) -> None:
    stand_ins = StandIns(tmp_path)
    stand_ins.add("apt-get")
    asks = 'printf "[sudo] password: " > /dev/tty; read p < /dev/tty; '
    stand_ins.add("sudo", SUDO_ASKS.replace("exec", asks + "exec"))
    code = f"""
import os
os.environ.pop("INSTALL_SYSTEM", None)
os.getuid = lambda: 1000
from grader.common import package_managers
from grader.setup import provide
package_managers.SYSTEM_PATH = ()
needs = [package_managers.Need("cmake", "cmake"), package_managers.Need("bubblewrap", "bubblewrap", "no marks")]
print("why:", repr(provide.provide(needs, {{**os.environ, "PATH": "{tmp_path}:/usr/bin:/bin"}}, print)))
"""
    ours, theirs = pty.openpty()
    # Start the command in a new session, so that sudo finds this terminal.
    command = ["setsid", "--ctty", sys.executable, "-c", code]
    with subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs):
        os.close(theirs)
        said = _until(ours, "password: ")
        os.write(ours, b"secret\n")
        said += _until(ours, "why: ''")
    os.close(ours)
    install = [call for call in stand_ins.calls() if call.startswith("sudo")]
    assert len(install) == 2, install
    assert install[0] == "sudo -n true"
    shown = said[: said.index("password: ")]
    assert f"sudo sh -c '{install[1].removeprefix('sudo sh -c ')}'" in shown
    assert [call for call in stand_ins.calls() if call.startswith("apt-get")] == [
        "apt-get update -q",
        f"{APT} cmake",
        f"{APT} bubblewrap",
    ]


def _until(terminal: int, word: str) -> str:
    said = ""
    while word not in said:
        said += os.read(terminal, 4096).decode()
    return said
