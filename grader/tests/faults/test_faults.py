"""If a system call fails during the grading of a submission, no points are lost, and every message is one sentence."""

from __future__ import annotations

import errno
import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from grader.tests.case import ROOT
from grader.tests.faults.inject import ALL, Done, Fault, no_traceback, run

SOLUTION = ROOT / "solutions/03-circle-publisher"
EVERY_DAY = [
    ("open", errno.EMFILE, 3),
    ("fork", errno.EAGAIN, 2),
    ("write", errno.ENOSPC, 2),
    ("thread", errno.EAGAIN, 1),
]
IN_ROOMS = [
    ("open", errno.EMFILE, 1),
    ("thread", errno.EAGAIN, 1),
    ("fork", errno.EAGAIN, 1),
    ("pipe", errno.EMFILE, 1),
]


@dataclass(frozen=True)
class Checked:
    done: Done
    statuses: set[str]
    points: tuple[float, float] | None


def checked(folder: Path, shim: Path, fault: Fault) -> Checked:
    """Check a correct submission while a kind of system call fails."""
    file = folder / "report.json"
    done = run(["grader", "check", str(SOLUTION), "--json", str(file)], folder, shim, fault)
    report = json.loads(file.read_text("utf-8")) if file.exists() and file.stat().st_size else None
    statuses = {outcome["status"] for outcome in report["outcomes"]} if report else set()
    points = (report["points"], report["max"]) if report else None
    return Checked(done, statuses, points)


def beside_a_trial(call: str, number: int, nth: int) -> Fault:
    return Fault(call, number, nth, "grader.grading.grade:grade")


def in_a_room(call: str, number: int, nth: int) -> Fault:
    return Fault(call, number, nth, "grader.trial.launchers:LauncherInCell", in_rooms=True)


def judge(checked: Checked) -> None:
    done = checked.done
    no_traceback(done)
    if done.code == 0:
        assert checked.points == (100, 100), done
    else:
        assert done.code == 3, done
        assert "failed" not in checked.statuses, done
        assert "error" in checked.statuses or done.said.count("grader: ") == 1, done


def test_the_shim_without_a_fault_stops_no_call(tmp_path: Path, shim: Path) -> None:
    passed = checked(tmp_path, shim, beside_a_trial("open", errno.EMFILE, 10**9))
    judge(passed)
    assert (passed.done.code, passed.done.failures) == (0, 0), passed.done.said


@pytest.mark.parametrize(("call", "number", "nth"), EVERY_DAY)
def test_a_failed_system_call_is_reported_in_one_sentence(
    tmp_path: Path, shim: Path, call: str, number: int, nth: int
) -> None:
    refused = checked(tmp_path, shim, beside_a_trial(call, number, nth))
    judge(refused)
    assert refused.done.failures > 0


@pytest.mark.parametrize(("call", "number", "nth"), IN_ROOMS)
def test_a_failed_system_call_of_a_conductor_is_reported_in_one_sentence(
    tmp_path: Path, shim: Path, call: str, number: int, nth: int
) -> None:
    refused = checked(tmp_path, shim, in_a_room(call, number, nth))
    judge(refused)
    assert refused.done.code == 3, refused.done.said
    assert "The simulator failed. " in refused.done.said
    assert "`.." not in refused.done.said


def test_a_full_disk_behind_standard_output_is_reported_in_one_sentence() -> None:
    command = [str(Path(sys.prefix, "bin/grader")), "check", str(SOLUTION)]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr.count("grader: The disk is full")) == (3, 1), done.stderr
    assert "Exception ignored" not in done.stderr


@pytest.mark.exhaustive
@pytest.mark.parametrize(("call", "number", "nth"), ALL)
def test_no_failed_system_call_is_a_traceback(tmp_path: Path, shim: Path, call: str, number: int, nth: int) -> None:
    judge(checked(tmp_path, shim, beside_a_trial(call, number, nth)))
