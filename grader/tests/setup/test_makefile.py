from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from grader.setup import bootstrap
from grader.tests.stand_ins import StandIns

ROOT = Path(bootstrap.__file__).parents[2]


def make(*arguments: str, **env: str) -> subprocess.CompletedProcess[str]:
    variables = [f"{name}={value}" for name, value in {"HOME": "/nowhere", **env}.items()]
    command = ["env", "-i", *variables, "make", "--no-print-directory", *arguments]
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


@pytest.mark.parametrize("shim", ["echo 'pyenv: python3: command not found' >&2; exit 127", "exit 0"])
def test_a_program_named_python3_that_is_no_python_is_passed_over(tmp_path: Path, shim: str) -> None:
    StandIns(tmp_path).add("python3", shim)
    (line,) = make("-n", "cluster", PATH=f"{tmp_path}:/usr/bin:/bin").stdout.splitlines()[1:]
    assert line.startswith("/usr/bin/python3 -EsB"), line


def test_git_for_windows_does_not_change_the_ends_of_lines(tmp_path: Path) -> None:
    """Otherwise, no shell script runs in a clone that Git for Windows has made inside WSL."""
    subprocess.run(["git", "init", "-q", tmp_path], check=True)
    shutil.copy(ROOT / ".gitattributes", tmp_path)
    asked = ["git", "-C", str(tmp_path), "check-attr", "text", "Makefile", "grader/ros/setup.bash"]
    said = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
    assert said.splitlines() == ["Makefile: text: unset", "grader/ros/setup.bash: text: unset"]


def test_ci_runs_the_readmes_command() -> None:
    script = ROOT / ".ci/run"
    assert os.access(script, os.X_OK)
    assert "make test" in script.read_text(encoding="utf-8")
