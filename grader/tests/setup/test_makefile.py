from __future__ import annotations

import os
import subprocess
from pathlib import Path

from grader.setup import bootstrap

ROOT = Path(bootstrap.__file__).parents[2]


def make(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = ["env", "-i", "HOME=/nowhere", "make", "--no-print-directory", *arguments]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def test_make_exports_a_path_where_there_is_none() -> None:
    shown = make("--eval", "show: ; @env", "show").stdout
    path = next(line for line in shown.splitlines() if line.startswith("PATH="))
    assert {"/usr/bin", "/bin", "/usr/sbin"} <= set(path[len("PATH=") :].split(":"))


def test_make_help_lists_every_target() -> None:
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = text.split(".PHONY: ")[1].splitlines()[0].split()
    assert [line.split()[1] for line in make("help").stdout.splitlines()] == sorted(targets, key=targets.index)


def test_make_hands_on_the_python_requested_and_no_other() -> None:
    assert "--python python3.12" in make("-n", "demo", "PYTHON=python3.12").stdout
    assert "--python" not in make("-n", "demo").stdout


def test_ci_runs_the_readmes_command() -> None:
    script = ROOT / ".ci/run"
    assert os.access(script, os.X_OK)
    assert "make test" in script.read_text(encoding="utf-8")
