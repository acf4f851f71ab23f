"""The solutions pass with both clocks and from any start. Regrading the recordings gives the same result."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from grader.exercise.model import catalogue

ROOT = Path(__file__).resolve().parents[2]
STEPS = sorted(path.name for path in (ROOT / "solutions").iterdir() if path.is_dir())
COMPARED = ("id", "status", "points", "diagnosis", "cause")


def grader(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [str(Path(sys.executable).with_name("grader")), *map(str, arguments)]
    return subprocess.run(
        command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, timeout=600, cwd=ROOT
    )


def outcomes(report: Path) -> list[tuple[object, ...]]:
    return [tuple(outcome[key] for key in COMPARED) for outcome in json.loads(report.read_text())["outcomes"]]


def test_every_step_has_its_three_folders() -> None:
    assert sorted(path.parent.name for path in (ROOT / "course").glob("*/exercise.toml")) == STEPS
    assert sorted(path.parent.name for path in (ROOT / "course").glob("*/lesson.md")) == STEPS
    assert sorted(path.name for path in (ROOT / "exercises").iterdir() if path.is_dir()) == STEPS


@pytest.mark.exhaustive
@pytest.mark.parametrize("step", STEPS)
def test_a_solution_passes_in_wall_time(step: str) -> None:
    done = grader("check", f"solutions/{step}", "--clock", "wall")
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", [1, 2, 3, 5, 8])
@pytest.mark.parametrize("step", [step for step in catalogue() if step >= "05"])
def test_a_solution_passes_from_any_start(step: str, seed: int) -> None:
    done = grader("check", f"solutions/{step}", "--seed", seed)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    "step",
    [
        "02-discover-topics",
        "11-bags",
        pytest.param("07-challenges", marks=pytest.mark.exhaustive),
        pytest.param("13-catch-them-all", marks=pytest.mark.exhaustive),
    ],
)
def test_a_recording_is_judged_again(step: str, tmp_path: Path) -> None:
    """The steps include one without a package, one without a simulator, and steps with several trials or nodes."""
    first, again, kept = tmp_path / "first.json", tmp_path / "again.json", tmp_path / "kept"
    assert grader("check", f"solutions/{step}", "--json", first, "--recording", kept).returncode == 0
    done = grader("regrade", kept, "--json", again)
    assert done.returncode == 0, done.stdout + done.stderr
    assert outcomes(again) == outcomes(first)
