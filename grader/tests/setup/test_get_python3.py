"""`make` installs python3 if it is missing.

The package manager is a fake program, which installs another fake program.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from grader import setup
from grader.tests.lacking import give_up
from grader.tests.stand_ins import StandIns

SCRIPT = Path(setup.__file__).parent / "get_python3.sh"
MAKEFILE = SCRIPT.parents[2] / "Makefile"
SUDO_FREE = '[ "$1" = -n ] && shift; exec "$@"'
SUDO_ASKS = '[ "$1" = -n ] && exit 1; exec "$@"'


class Machine:
    """A machine without python3.

    The PATH of the machine contains fake programs and the few real programs that the script runs.
    """

    def __init__(self, folder: Path, user: int) -> None:
        self.folder = folder
        self.stand_ins = StandIns(folder)
        self.stand_ins.add("id", f"echo {user}")
        for name in ("sh", "tail"):
            (folder / name).symlink_to(shutil.which(name) or name)

    def add_manager(self, name: str) -> None:
        brings = f'case "$*" in *install*|*-S*) ln -s /bin/true "{self.folder}/python3";; esac'
        self.stand_ins.add(name, f"echo lots of output; {brings}")

    def run(self, **env: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [self.folder / "sh", SCRIPT],
            env={"PATH": str(self.folder), **env},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )

    def calls(self) -> list[str]:
        return [call for call in self.stand_ins.calls() if not call.startswith("id ")]


@pytest.mark.parametrize(
    ("program", "calls"),
    [
        ("apt-get", ["apt-get update", "apt-get install -y python3 python3-venv python3-dev"]),
        ("dnf", ["dnf install -y python3 python3-devel"]),
        ("pacman", ["pacman -Sy --needed --noconfirm python"]),
        ("zypper", ["zypper --non-interactive install python3 python3-devel"]),
    ],
)
@pytest.mark.parametrize("user", [0, 1000])
def test_root_and_sudo_without_a_password_install_it(tmp_path: Path, program: str, calls: list[str], user: int) -> None:
    machine = Machine(tmp_path, user)
    machine.add_manager(program)
    if user:
        machine.stand_ins.add("sudo", SUDO_FREE)
    done = machine.run()
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.count("\n") == 1
    assert [call for call in machine.calls() if not call.startswith("sudo")] == calls


@pytest.mark.parametrize("sudo", ["", SUDO_ASKS])
def test_without_rights_the_command_is_reported(tmp_path: Path, sudo: str) -> None:
    machine = Machine(tmp_path, 1000)
    machine.add_manager("apt-get")
    if sudo:
        machine.stand_ins.add("sudo", sudo)
    done = machine.run()
    assert done.returncode == 3
    assert "python3 is not installed. Install it as root, then run make again: apt-get update && " in done.stderr
    assert [call for call in machine.calls() if call.startswith("apt-get")] == []


def test_nothing_is_touched_where_that_was_requested(tmp_path: Path) -> None:
    machine = Machine(tmp_path, 0)
    machine.add_manager("apt-get")
    assert machine.run(INSTALL_SYSTEM="0").returncode == 3
    assert machine.calls() == []


def test_a_failure_is_reported_in_the_managers_own_words(tmp_path: Path) -> None:
    machine = Machine(tmp_path, 0)
    machine.stand_ins.add("apt-get", "echo 'E: Could not get lock' >&2; exit 100")
    done = machine.run()
    assert done.returncode == 3
    assert "E: Could not get lock" in done.stderr


def test_without_a_package_manager_that_is_said(tmp_path: Path) -> None:
    done = Machine(tmp_path, 0).run()
    assert (done.returncode, "python3 is not installed." in done.stderr) == (3, True)


def test_make_runs_it_where_there_is_no_python3(tmp_path: Path) -> None:
    machine = Machine(tmp_path / "bin", 0)
    program = shutil.which("make") or give_up("make", "make")
    without = MAKEFILE.read_text("utf-8").replace("/usr/bin:/sbin:/bin", "").replace("/usr/sbin:", "")
    without = without.replace("python3 /usr/bin/python3;", "python3;")
    (tmp_path / "Makefile").write_text(without)
    (tmp_path / "grader").symlink_to(SCRIPT.parents[1])
    env = {"PATH": machine.stand_ins.path}
    done = subprocess.run([program, "python3"], cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
    assert "python3 is not installed." in done.stderr, done


def test_the_script_holds_for_shellcheck() -> None:
    program = shutil.which("shellcheck") or give_up("shellcheck", "shellcheck")
    done = subprocess.run([program, SCRIPT], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "")
