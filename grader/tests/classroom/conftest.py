from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import pytest

from grader.sandbox import bubblewrap
from grader.tests.classroom.a_class import STEP, grade, make_class

if TYPE_CHECKING:
    import subprocess
    from pathlib import Path


@dataclass(frozen=True)
class Run:
    """A class, and the results of an undisturbed grading of it."""

    submitted: Path
    out: Path
    done: subprocess.CompletedProcess[str]


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> Run:
    if not bubblewrap.usable():
        pytest.skip("there is no sandbox here")
    folder = tmp_path_factory.mktemp("class")
    submitted = make_class(folder / "submitted")
    return Run(submitted, folder / "grades", grade(submitted, "--exercise", STEP, "--out", folder / "grades"))
