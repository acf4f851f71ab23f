"""Tests of the first lines of the commands' scripts, which run before a module of the grader is imported."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import grader.setup
from grader.tests.both_worlds import python_path

COMMANDS = Path(grader.setup.__file__).parent / "commands"
INTERRUPTED = """
import sys


class Interrupting:
    def find_spec(self, name, *_):
        if name.startswith("grader."):
            raise KeyboardInterrupt


sys.meta_path.insert(0, Interrupting())
"""


MISSING = """
import sys


class Missing:
    def find_spec(self, name, *_):
        if name == {name!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)


sys.meta_path.insert(0, Missing())
"""


CODES = {"grader": 130, "ros2": 2, "rqt": 130, "rqt_console": 130, "rqt_graph": 130, "rqt_plot": 130}
"""The commands, with their exit codes after Ctrl-C."""


with_block_signal = pytest.mark.skipif(
    subprocess.run(["/usr/bin/env", "--block-signal=INT", "true"], capture_output=True, check=False).returncode != 0,
    reason="this test needs an `env` with the option --block-signal",
)


@pytest.mark.parametrize(("name", "code"), CODES.items())
def test_ctrl_c_during_the_import_prints_no_traceback(tmp_path: Path, name: str, code: int) -> None:
    done = run(tmp_path, name, INTERRUPTED)
    assert (done.returncode, done.stdout, done.stderr) == (code, "", "")


@with_block_signal
@pytest.mark.parametrize(("name", "code"), CODES.items())
def test_ctrl_c_while_python_itself_starts_prints_no_traceback(tmp_path: Path, name: str, code: int) -> None:
    done = run(tmp_path, name, "import os, signal\nos.kill(os.getpid(), signal.SIGINT)\n")
    assert (done.returncode, done.stdout, done.stderr) == (code, "", "")


@pytest.mark.parametrize("name", CODES)
@pytest.mark.parametrize(
    ("module", "changed"),
    [
        ("grader", "moved or renamed"),
        ("grader.common", "changed (No module named 'grader.common')"),
    ],
)
def test_a_course_that_was_moved_or_updated_names_the_command_that_sets_it_up(
    tmp_path: Path, name: str, module: str, changed: str
) -> None:
    done = run(tmp_path, name, MISSING.format(name=module))
    again = f"Set it up again: cd {shlex.quote(str(Path(sys.prefix).parent))} && make demo"
    said = f"{name}: the course was {changed} after its set-up. {again}\n"
    assert (done.returncode, done.stdout, done.stderr) == (3, "", said)


@pytest.mark.parametrize("name", CODES)
@pytest.mark.parametrize("way", ["by its path", "in PATH", "through a link"])
def test_a_python_that_was_removed_names_the_command_that_sets_the_course_up(
    tmp_path: Path, name: str, way: str
) -> None:
    """After an upgrade of the system, .venv/bin/python3 can be a link to a Python that no longer exists."""
    folder = tmp_path / "my course/.venv/bin"
    folder.mkdir(parents=True)
    command = Path(shutil.copy(COMMANDS / name, folder))
    command.chmod(0o755)
    (folder / "python3").symlink_to("/usr/bin/python3.99")
    (tmp_path / "elsewhere").mkdir()
    link = tmp_path / "elsewhere" / name
    link.symlink_to(command)
    typed = {"by its path": str(command), "in PATH": name, "through a link": str(link)}[way]
    env = {"PATH": f"{folder}:/usr/bin:/bin"}
    done = subprocess.run(["sh", "-c", typed.replace(" ", "\\ ")], env=env, capture_output=True, text=True, check=False)
    again = f'Set it up again: cd "{tmp_path}/my course" && make demo'
    said = f"{name}: the Python of the course was removed after its set-up. {again}\n"
    assert (done.returncode, done.stdout, done.stderr) == (3, "", said)


def run(folder: Path, name: str, customized: str) -> subprocess.CompletedProcess[str]:
    """Run `NAME status` with the code `customized` at the start of Python. Copy the command to the folder first."""
    (folder / "sitecustomize.py").write_text(customized)
    command = Path(shutil.copy(COMMANDS / name, folder))
    python = folder / "python3"
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    for file in (command, python):
        file.chmod(0o755)
    env = {**os.environ, "PYTHONPATH": python_path(folder)}
    return subprocess.run([str(command), "status"], env=env, capture_output=True, text=True, check=False)
