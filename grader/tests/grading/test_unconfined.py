"""Grading your own work on a machine without bubblewrap."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from grader.sandbox import bubblewrap
from grader.tests.both_worlds import SOURCED_ENV, python_path
from grader.tests.case import copy_solution

if TYPE_CHECKING:
    from collections.abc import Sequence

STEP = "03-circle-publisher"
WITHOUT = "import grader.sandbox.bubblewrap\ngrader.sandbox.bubblewrap.program = lambda: None\n"


@pytest.fixture
def without(tmp_path: Path) -> dict[str, str]:
    """Return the environment of a machine without bubblewrap."""
    (tmp_path / "sitecustomize.py").write_text(WITHOUT)
    return {**os.environ, "PYTHONPATH": python_path(tmp_path), "XDG_STATE_HOME": str(tmp_path / "state")}


def grader(env: dict[str, str], *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [Path(sys.prefix, "bin/grader"), *arguments]
    return subprocess.run(command, env=env, capture_output=True, text=True, check=False)


def alike(report: dict[str, Any]) -> Sequence[object]:
    return [[(o["id"], o["status"], o["points"], o["diagnosis"]) for o in report["outcomes"]], report["clock"]]


@pytest.mark.parametrize("clock", ["simulated", pytest.param("wall", marks=pytest.mark.exhaustive)])
def test_the_verdict_is_that_of_a_sandbox_and_the_report_says_so(
    tmp_path: Path, without: dict[str, str], clock: str
) -> None:
    if not bubblewrap.usable():
        pytest.skip("there is no sandbox here to compare with")
    package = tmp_path / "my_robot_controller"
    copy_solution(STEP, package)
    confined = {**without, "PYTHONPATH": SOURCED_ENV.get("PYTHONPATH", "")}
    reports = []
    for name, env in (("without", without), ("within", confined)):
        report, kept = tmp_path / f"{name}.json", tmp_path / f"{name}.kept"
        options = ("--exercise", STEP, "--clock", clock, "--json", report, "--recording", kept)
        done = grader(env, "check", package, *options)
        assert done.returncode == 0, done.stdout + done.stderr
        assert ("without a sandbox" in done.stdout) == (name == "without")
        reports.append(json.loads(report.read_text()))
        done = grader(confined, "regrade", kept, "--json", report)
        assert ("without a sandbox" in done.stdout) == (name == "without")
        assert json.loads(report.read_text())["confined"] == (name == "within")
    assert alike(reports[0]) == alike(reports[1])
    assert [report["confined"] for report in reports] == [False, True]


def test_check_with_the_option_sandbox_fails_without_a_sandbox(tmp_path: Path, without: dict[str, str]) -> None:
    copy_solution(STEP, tmp_path / "my_robot_controller")
    done = grader(without, "check", tmp_path / "my_robot_controller", "--exercise", STEP, "--sandbox")
    assert (done.returncode, done.stdout) == (3, "")
    assert "install -y bubblewrap" in done.stderr
    assert "Traceback" not in done.stderr
