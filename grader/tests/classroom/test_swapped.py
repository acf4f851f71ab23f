"""Students who own their folders replace files and folders after the submissions were found."""

from __future__ import annotations

import os
import shutil
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.classroom.content import fingerprint, read
from grader.classroom.find_submissions import find_submissions
from grader.classroom.refused import Refused
from grader.tests.case import copy_solution
from grader.tests.classroom.a_class import zipped

if TYPE_CHECKING:
    from pathlib import Path

    from grader.classroom.found import Found

STEP = "03-circle-publisher"
ANSWERS = "02-discover-topics"


def found(folder: Path, step: str) -> Found:
    return next(each for each in find_submissions([folder], step, folder / "grades") if each.student == "ben")


def reason(of: Found, step: str) -> str:
    content = read(of, find_exercise(step), "ben")
    assert isinstance(content, Refused), content
    assert not content.of_the_machine
    return content.reason


@pytest.mark.parametrize("step", [STEP, ANSWERS])
@pytest.mark.parametrize("replaced", ["exercises", "exercises/STEP", "."])
def test_a_folder_that_became_a_link_to_another_students_folder(tmp_path: Path, step: str, replaced: str) -> None:
    for student in ("anna", "ben"):
        copy_solution(step, tmp_path / student / "exercises" / step)
    ben = found(tmp_path, step)
    assert not isinstance(read(ben, find_exercise(step), "ben"), Refused)
    path = os.path.normpath(replaced.replace("STEP", step))
    shutil.rmtree(tmp_path / "ben" / path)
    (tmp_path / "ben" / path).symlink_to(tmp_path / "anna" / path)
    assert "changed while it was being read" in reason(ben, step)


def test_an_archive_that_became_a_link_to_another_students_archive(tmp_path: Path) -> None:
    copy_solution(STEP, tmp_path / "made")
    for student in ("anna", "ben"):
        zipped(tmp_path / "made", tmp_path / f"{student}.zip", "my_robot_controller")
    shutil.rmtree(tmp_path / "made")
    ben = found(tmp_path, STEP)
    (tmp_path / "ben.zip").unlink()
    (tmp_path / "ben.zip").symlink_to(tmp_path / "anna.zip")
    assert reason(ben, STEP) == "ben.zip changed while it was being read."


def test_a_folder_with_an_archive_that_became_a_link(tmp_path: Path) -> None:
    copy_solution(STEP, tmp_path / "made")
    for student in ("anna", "ben"):
        (tmp_path / student).mkdir()
        zipped(tmp_path / "made", tmp_path / student / "work.zip", "my_robot_controller")
    shutil.rmtree(tmp_path / "made")
    ben = found(tmp_path, STEP)
    shutil.rmtree(tmp_path / "ben")
    (tmp_path / "ben").symlink_to(tmp_path / "anna")
    assert reason(ben, STEP) == "ben changed while it was being read."


def test_an_archive_that_became_a_pipe_does_not_stop_the_grader(tmp_path: Path) -> None:
    (tmp_path / "ben.zip").touch()
    ben = found(tmp_path, STEP)
    (tmp_path / "ben.zip").unlink()
    os.mkfifo(tmp_path / "ben.zip")
    assert "is not a regular file" in reason(ben, STEP)
    assert fingerprint(ben, find_exercise(STEP))
