"""What the system refuses while a submission is graded is a sentence, or changes nothing; it costs no points."""

from __future__ import annotations

import errno
import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from grader.tests.case import ROOT

SOLUTION = ROOT / "solutions/03-circle-publisher"
ARMED = """
import ctypes, os
import grader.grading.grade as module
real = module.grade
def armed(*arguments, **options):
    ctypes.CDLL(os.environ["LD_PRELOAD"]).fault_arm()
    return real(*arguments, **options)
module.grade = armed
"""
CALLS = {
    "open": (errno.EMFILE, errno.ENOMEM, errno.EPERM),
    "write": (errno.ENOSPC,),
    "pipe": (errno.EMFILE, errno.ENFILE),
    "mkdir": (errno.ENOSPC, errno.EPERM),
    "fork": (errno.EAGAIN, errno.ENOMEM),
    "thread": (errno.EAGAIN,),
    "memfd": (errno.EMFILE, errno.ENOMEM),
    "flock": (errno.EPERM, errno.ENOMEM),
    "epoll": (errno.EMFILE, errno.ENOMEM),
}
EVERY_DAY = [
    ("open", errno.EMFILE, 3),
    ("fork", errno.EAGAIN, 2),
    ("write", errno.ENOSPC, 2),
    ("thread", errno.EAGAIN, 1),
]
ALL = [(call, number, nth) for call, numbers in CALLS.items() for number in numbers for nth in (1, 2, 4, 9, 30)]


@dataclass(frozen=True)
class Done:
    code: int
    said: str
    statuses: set[str]
    points: tuple[float, float] | None
    failures: int
    """How many calls failed."""


def checked(folder: Path, shim: Path, call: str, number: int, nth: int) -> Done:
    """Check a right submission while the system refuses a kind of call."""
    (folder / "sitecustomize.py").write_text(ARMED)
    log, file = folder / "failures", folder / "report.json"
    env = {**os.environ, "PYTHONPATH": str(folder), "LD_PRELOAD": str(shim), "FAULT_LOG": str(log)}
    env["FAULT"] = f"{call} {number} {nth}"
    command = [str(Path(sys.prefix, "bin/grader")), "check", str(SOLUTION), "--json", str(file)]
    done = subprocess.run(command, env=env, capture_output=True, text=True, timeout=300, check=False)
    report = json.loads(file.read_text("utf-8")) if file.exists() and file.stat().st_size else None
    statuses = {outcome["status"] for outcome in report["outcomes"]} if report else set()
    points = (report["points"], report["max"]) if report else None
    failures = len(log.read_text("utf-8").splitlines()) if log.exists() else 0
    return Done(done.returncode, done.stdout + done.stderr, statuses, points, failures)


def judge(done: Done) -> None:
    for trace in ("Traceback", "Exception in thread", "Exception ignored", "Fatal Python error"):
        assert trace not in done.said, done.said
    if done.code == 0:
        assert done.points == (100, 100), done
    else:
        assert done.code == 3, done
        assert "failed" not in done.statuses, done
        assert "error" in done.statuses or done.said.count("grader: ") == 1, done


def test_the_shim_lets_everything_pass_that_it_is_not_to_stop(tmp_path: Path, shim: Path) -> None:
    done = checked(tmp_path, shim, "open", errno.EMFILE, 10**9)
    judge(done)
    assert (done.code, done.failures) == (0, 0), done.said


@pytest.mark.parametrize(("call", "number", "nth"), EVERY_DAY)
def test_what_the_system_refuses_is_a_sentence(tmp_path: Path, shim: Path, call: str, number: int, nth: int) -> None:
    done = checked(tmp_path, shim, call, number, nth)
    judge(done)
    assert done.failures > 0


def test_a_full_disk_behind_standard_output_is_a_sentence() -> None:
    command = [str(Path(sys.prefix, "bin/grader")), "check", str(SOLUTION)]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr.count("grader: The disk is full")) == (3, 1), done.stderr
    assert "Exception ignored" not in done.stderr


@pytest.mark.exhaustive
@pytest.mark.parametrize(("call", "number", "nth"), ALL)
def test_nothing_that_the_system_refuses_is_a_traceback(
    tmp_path: Path, shim: Path, call: str, number: int, nth: int
) -> None:
    judge(checked(tmp_path, shim, call, number, nth))
