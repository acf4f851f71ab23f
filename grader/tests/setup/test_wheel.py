"""The course as a wheel, installed outside a checkout: the same commands work in an empty home folder."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from grader.exercise.model import catalogue
from grader.setup import lock
from grader.tests.learner.story import Learner, walk

ROOT = Path(__file__).resolve().parents[3]
UV = str(Path(sys.executable).with_name("uv"))
FIRST, SECOND = list(catalogue())[:2]


def run(*argv: object, cwd: Path, env: dict[str, str] | None = None) -> str:
    done = subprocess.run(
        list(map(str, argv)), cwd=cwd, env=env, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture
def installed(tmp_path: Path) -> Path:
    """Return the command `grader` in an environment created from the lock file and our wheel."""
    run(UV, "build", "--wheel", "--no-build-isolation", "--out-dir", tmp_path / "dist", ".", cwd=ROOT)
    run(UV, "venv", "--python", sys.executable, tmp_path / "venv", cwd=tmp_path)
    install = (UV, "pip", "install", "--python", tmp_path / "venv/bin/python", "--no-deps", "--no-build-isolation")
    text = lock.LOCK_FILE.read_text("utf-8")
    # setuptools first, since it builds packages without a wheel
    for name, only in (("first", frozenset({"setuptools"})), ("rest", None)):
        file = tmp_path / f"{name}.txt"
        file.write_text(lock.select(text, ["setup", "grader", "ros"], only=only))
        run(*install, "--require-hashes", "-r", file, cwd=tmp_path)
    run(*install, *(tmp_path / "dist").glob("*.whl"), cwd=tmp_path)
    return tmp_path / "venv/bin/grader"


@pytest.mark.exhaustive
def test_what_learners_do_and_the_instructors_without_a_checkout(installed: Path, tmp_path: Path) -> None:
    home = tmp_path / "home"
    home.mkdir()
    learner = Learner(home, str(installed))
    learner.env.pop("PYTHONPATH", None)
    walk(learner, [FIRST, SECOND])

    env = {**learner.env, "PATH": f"{installed.parent}:{os.environ['PATH']}"}
    assert "No problems found." in run(installed, "validate", FIRST, cwd=home, env=env)
    assert "up to date" in run(installed, "release", "--check", cwd=home, env=env)
    run(installed, "release", "--to", home / "students", cwd=home, env=env)
    assert (home / "students/course" / FIRST / "lesson.md").is_file()
    assert (home / "students/exercises" / FIRST).is_dir()
    assert "\ndemo: python3 " in (home / "students/Makefile").read_text("utf-8")
    assert not list((home / "students").rglob("solutions"))
