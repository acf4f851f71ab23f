"""Students who own their folders replace files and folders after the submissions were found."""

from __future__ import annotations

import os
import shutil
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.exercises import find_exercise
from grader.classroom.class_run import run
from grader.classroom.content import fingerprint, read
from grader.classroom.find_submissions import find_submissions
from grader.classroom.order import Order, sort_out, sources_for
from grader.classroom.progress_display import Lines
from grader.classroom.refused import Refused
from grader.classroom.results import opened
from grader.submission import reader
from grader.tests.case import copy_solution
from grader.tests.classroom.a_class import zipped
from grader.tests.classroom.test_again import Scripted

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
    assert reason(ben, STEP) == "ben/work.zip changed while it was being read."


def test_an_archive_that_became_a_pipe_does_not_stop_the_grader(tmp_path: Path) -> None:
    (tmp_path / "ben.zip").touch()
    ben = found(tmp_path, STEP)
    (tmp_path / "ben.zip").unlink()
    os.mkfifo(tmp_path / "ben.zip")
    assert "is not a regular file" in reason(ben, STEP)
    assert fingerprint(ben, find_exercise(STEP))


@pytest.mark.parametrize("archive", [False, True])
def test_files_that_change_before_they_are_read_and_change_back_are_graded_again(tmp_path: Path, archive: bool) -> None:
    for text in ("own", "another"):
        copy_solution(STEP, tmp_path / text / "ben")
        (tmp_path / text / "ben/setup.cfg").write_text(f"# {text}")
        if archive:
            zipped(tmp_path / text / "ben", tmp_path / text / "ben.zip", "my_robot_controller")
            shutil.rmtree(tmp_path / text / "ben")

    def hand_in(text: str) -> None:
        shutil.rmtree(tmp_path / "class", ignore_errors=True)
        shutil.copytree(tmp_path / text, tmp_path / "class")

    def left_to_do(*, swapped: bool) -> int:
        each = find_submissions([tmp_path / "class"], STEP, tmp_path / "grades")
        order = Order(found=each, roster={}, sources=sources_for(each, None), ros="none")
        with opened(tmp_path / "grades") as results:
            _, todo = sort_out(order, results)
            if swapped:
                hand_in("another")
            run(order, todo, Scripted({"ben": ["passed"]}), results, Lines(len(todo), several=False))
        return len(todo)

    hand_in("own")
    assert left_to_do(swapped=True) == 1
    hand_in("own")
    assert left_to_do(swapped=False) == 1
    assert left_to_do(swapped=False) == 0


@pytest.mark.parametrize("damaged", [False, True])
def test_an_archive_that_changes_while_it_is_read_and_changes_back_has_the_key_of_what_was_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, damaged: bool
) -> None:
    copy_solution(STEP, tmp_path / "made/ben")
    for text in ("own", "another"):
        (tmp_path / "made/ben/setup.cfg").write_text(f"# {text}")
        zipped(tmp_path / "made/ben", tmp_path / f"{text}.zip", "my_robot_controller")
    if damaged:
        (tmp_path / "another.zip").write_bytes(b"PK and no more")
    archive = tmp_path / "class" / "ben.zip"
    archive.parent.mkdir()
    exercise = find_exercise(STEP)

    def hand_in(text: str) -> None:
        shutil.copyfile(tmp_path / f"{text}.zip", archive)

    prints = {}
    for text in ("another", "own"):
        hand_in(text)
        each = find_submissions([tmp_path / "class"], STEP, tmp_path / "grades")
        prints[text] = fingerprint(each[0], exercise)
    order = Order(found=each, roster={}, sources=sources_for(each, None), ros="none")
    read_in_child = reader.read

    def swapping(*given: Any) -> Any:  # noqa: ANN401
        hand_in("another")  # from here on, until the archive has been read
        try:
            return read_in_child(*given)
        finally:
            hand_in("own")

    for when in ("while it is unpacked", "before the task"):
        with monkeypatch.context() as patch:
            if when == "while it is unpacked":
                patch.setattr(reader, "read", swapping)
            else:
                hand_in("another")
            task = order.task(each[0])
        hand_in("own")
        graded = "another"
        if isinstance(task.content, dict):
            graded = task.content["setup.cfg"].decode().removeprefix("# ")
        assert order.key(each[0], task).submission == prints[graded], when
