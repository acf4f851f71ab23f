from __future__ import annotations

import subprocess
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pytest

from grader.sandbox import bubblewrap
from grader.tests.classroom.a_class import STEP, grade, make_class
from grader.tests.shared import made_once

if TYPE_CHECKING:
    from pathlib import Path


@dataclass(frozen=True)
class Run:
    """A class, and the results of grading it without interruption."""

    submitted: Path
    out: Path
    done: subprocess.CompletedProcess[str]


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Return a shared run. Tests in several processes use the same run, so they must not change its folders."""
    if not bubblewrap.usable():
        pytest.skip("there is no sandbox here")

    def make(folder: Path) -> list[Any]:
        done = grade(make_class(folder / "submitted"), "--exercise", STEP, "--out", folder / "grades")
        return [done.args, done.returncode, done.stdout, done.stderr]

    folder, done = made_once(tmp_path_factory, "class", make)
    return Run(folder / "submitted", folder / "grades", subprocess.CompletedProcess(*done))
