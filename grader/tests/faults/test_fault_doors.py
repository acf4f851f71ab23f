"""If a system call fails in a class, a learner's command, `ros2` or the set-up, a one-sentence message reports it."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pexpect
import pytest

from grader.setup import machine
from grader.tests.both_worlds import of_our_ros2
from grader.tests.case import ROOT
from grader.tests.faults.doors import DOORS, PACKAGE, SOLUTION, STEP, commanded
from grader.tests.faults.inject import ALL, LIMIT_S, Done, Fault, environment, failures, no_traceback

EVERY_DAY = [
    ("class", "fork", errno.EAGAIN, 1),
    ("class", "open", errno.EMFILE, 1),
    ("class", "open", errno.EPERM, 1),
    ("class", "mkdir", errno.ENOSPC, 1),
    ("start", "mkdir", errno.ENOSPC, 1),
    ("start", "open", errno.EPERM, 1),
    ("own run", "write", errno.ENOSPC, 1),
    ("new", "open", errno.EMFILE, 5),
    ("new", "mkdir", errno.ENOSPC, 40),
    ("sync", "fork", errno.EAGAIN, 1),
    ("compare", "open", errno.EMFILE, 1),
    ("env", "open", errno.EMFILE, 1),
    pytest.param("list", "open", errno.EMFILE, 1, marks=of_our_ros2),
    pytest.param("list", "thread", errno.EAGAIN, 1, marks=of_our_ros2),
    pytest.param("create", "mkdir", errno.ENOSPC, 1, marks=of_our_ros2),
    pytest.param("show", "open", errno.ENOMEM, 1, marks=of_our_ros2),
]
SET_UP = """
import ctypes, os, sys
from grader.setup import bootstrap, setup_errors
ctypes.CDLL(os.environ["LD_PRELOAD"]).fault_arm()
sys.exit(setup_errors.guarded(lambda: bootstrap.main(["learner"])))
"""


def reported(done: Done) -> None:
    """Check that the command exited with 0 or 1, or reported a machine error in a sentence."""
    no_traceback(done)
    if done.failures and done.code not in (0, 1):
        assert done.code == 3, done
        assert done.said.strip().splitlines()[-1].endswith("."), done
        assert "None" not in done.said, done


@pytest.mark.parametrize(("name", "call", "number", "nth"), EVERY_DAY)
def test_a_failed_system_call_of_a_command_is_reported_in_one_sentence(
    tmp_path: Path, shim: Path, name: str, call: str, number: int, nth: int
) -> None:
    done = commanded(name, tmp_path, shim, (call, number, nth))
    reported(done)
    assert done.failures > 0


@pytest.mark.parametrize(("call", "number"), [("fork", errno.EAGAIN), ("open", errno.EMFILE), ("mkdir", errno.ENOSPC)])
def test_watch_reports_a_failed_system_call_and_can_still_be_ended(
    tmp_path: Path, shim: Path, call: str, number: int
) -> None:
    package = tmp_path / PACKAGE
    shutil.copytree(SOLUTION / PACKAGE, package)
    env = environment(tmp_path, shim, Fault(call, number, 1, "grader.grading.grade:grade"))
    screen: pexpect.spawn[str] = pexpect.spawn(
        str(Path(sys.prefix, "bin/grader")),
        ["watch", str(package), "--exercise", STEP],
        env={**env, "TERM": "xterm-256color"},
        cwd=tmp_path,
        encoding="utf-8",
        timeout=LIMIT_S,
    )
    said = ""
    if screen.expect(["Watching .*quit", pexpect.EOF]) == 0:
        said = f"{screen.before}{screen.after}"
        screen.send("q")
        screen.expect(pexpect.EOF)
    screen.close()
    no_traceback(Done(screen.exitstatus or 0, said + (screen.before or ""), failures(tmp_path)))


def set_up(folder: Path, shim: Path, call: str, number: int, nth: int) -> Done:
    """Start the set-up in a folder that contains the necessary files."""
    for name in ("grader/setup", "grader/common"):
        shutil.copytree(ROOT / name, folder / name)
    for name in ("grader/__init__.py", "requirements.lock", "pyproject.toml"):
        shutil.copy(ROOT / name, folder / name)
    env = environment(folder, shim, Fault(call, number, nth, "os:getpid"))
    python = next(python for python in machine.find_pythons("/usr/bin") if python.venv)
    done = subprocess.run(
        [python.path, "-Es", "-c", f"import sys; sys.path.insert(0, {str(folder)!r})\n{SET_UP}"],
        cwd=folder,
        env={**env, "INSTALL_SYSTEM": "0", "PIP_INDEX_URL": "http://127.0.0.1:9/", "PIP_CONFIG_FILE": os.devnull},
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=False,
    )
    return Done(done.returncode, done.stdout + done.stderr, failures(folder))


@pytest.mark.parametrize(
    ("call", "number"),
    [
        ("open", errno.EMFILE),
        ("open", errno.ENOMEM),
        ("fork", errno.EAGAIN),
        ("fork", errno.ENOMEM),
        ("flock", errno.EPERM),
    ],
)
def test_a_failed_system_call_of_the_set_up_is_reported_in_one_sentence(
    tmp_path: Path, shim: Path, call: str, number: int
) -> None:
    done = set_up(tmp_path, shim, call, number, 1)
    reported(done)
    assert (done.code, done.failures > 0) == (3, True), done


@pytest.mark.exhaustive
@pytest.mark.parametrize(("call", "number", "nth"), ALL)
@pytest.mark.parametrize("name", DOORS)
def test_no_failed_system_call_of_a_command_is_a_traceback(
    tmp_path: Path, shim: Path, name: str, call: str, number: int, nth: int
) -> None:
    reported(commanded(name, tmp_path, shim, (call, number, nth)))
