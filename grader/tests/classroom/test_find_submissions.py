"""The submissions that are found in a folder, and the students that they belong to."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.classroom import results
from grader.classroom.content import fingerprint, read
from grader.classroom.find_submissions import find_submissions, left_out, passed_over
from grader.classroom.found import Found, what_to_do_with
from grader.classroom.own_folders import MARK
from grader.classroom.refused import Refused
from grader.errors import UsageError
from grader.exercise.model import catalogue
from grader.tests.case import copy_solution
from grader.tests.classroom.a_class import zipped

if TYPE_CHECKING:
    from pathlib import Path

STEP = "03-circle-publisher"


def names(folder: Path, exercise: str | None = STEP) -> list[tuple[str, str, str]]:
    found = find_submissions([folder], exercise, folder / "grades")
    return [(each.student, each.exercise, str(each.path.relative_to(folder))) for each in found]


def test_a_folder_of_folders_and_archives(tmp_path: Path) -> None:
    for name in ("anna", "Zoe", ".git", "__MACOSX", "grades"):
        (tmp_path / name).mkdir()
    for name in ("ben.zip", "._ben.zip", "clara.tar.gz", "roster.csv", ".DS_Store"):
        (tmp_path / name).touch()
    os.mkfifo(tmp_path / "pipe")
    assert passed_over([tmp_path], tmp_path / "grades") == (".git", "__MACOSX", "pipe", "roster.csv")
    assert names(tmp_path) == [
        ("Zoe", STEP, "Zoe"),
        ("anna", STEP, "anna"),
        ("ben", STEP, "ben.zip"),
        ("clara", STEP, "clara.tar.gz"),
    ]


def test_loose_notebooks_are_to_be_put_into_folders(tmp_path: Path) -> None:
    """As in the downloads of some LMS."""
    for name in ("anna_1.ipynb", "ben_2.ipynb", "grades.csv"):
        (tmp_path / name).touch()
    todo = r"To grade anna_1\.ipynb and ben_2\.ipynb, put each of them into a folder with the name of the student\.$"
    with pytest.raises(UsageError, match=f"No submission was found in .* {todo}"):
        names(tmp_path)
    assert what_to_do_with(["grades.csv"]) == ""


def test_nbgraders_tree(tmp_path: Path) -> None:
    for path in (f"anna/{STEP}", "anna/01-first-node", "ben/01-first-node", "ben/notes"):
        (tmp_path / path).mkdir(parents=True)
    assert names(tmp_path, None) == [
        ("anna", "01-first-node", "anna/01-first-node"),
        ("anna", STEP, f"anna/{STEP}"),
        ("ben", "01-first-node", "ben/01-first-node"),
    ]
    assert names(tmp_path, "01") == [
        ("anna", "01-first-node", "anna/01-first-node"),
        ("ben", "01-first-node", "ben/01-first-node"),
    ]


def test_a_folder_of_clones(tmp_path: Path) -> None:
    for student in ("anna", "ben"):
        for step in (STEP, "01-first-node"):
            copy_solution(step, tmp_path / student / "exercises" / step / "my_robot_controller")
        (tmp_path / student / ".git").mkdir()
    assert names(tmp_path) == [
        ("anna", STEP, f"anna/exercises/{STEP}"),
        ("ben", STEP, f"ben/exercises/{STEP}"),
    ]


@pytest.mark.parametrize("in_git", [False, True])
@pytest.mark.parametrize("name", ["exercises", "setup.py", "package.xml"])
def test_no_name_of_a_students_folder_hides_the_class(tmp_path: Path, name: str, *, in_git: bool) -> None:
    if in_git:
        (tmp_path / ".git").mkdir()
    for student in ("anna", "ben", name):
        copy_solution(STEP, tmp_path / student / "my_robot_controller")
    assert [student for student, *_ in names(tmp_path, STEP)] == sorted(["anna", "ben", name])


def test_hidden_folders_hidden_archives_and_links_have_a_line_with_the_reason(tmp_path: Path) -> None:
    for name in ("anna", "...", ".ben", ".git", "grades"):
        (tmp_path / name).mkdir()
    for name in (".clara.zip", ".rar", ".DS_Store"):
        (tmp_path / name).touch()
    for name, target in {"dora": "anna", "emil": "grades", "finn.zip": "nowhere"}.items():
        (tmp_path / name).symlink_to(target)
    found = find_submissions([tmp_path], STEP, tmp_path / "grades")
    reasons = {each.student: each.refused.reason if each.refused else "" for each in found}
    assert [student for student, reason in reasons.items() if "begins with a dot" in reason] == [
        "...",
        ".ben",
        ".clara",
        ".rar",
    ]
    assert [student for student, reason in reasons.items() if "symbolic link" in reason] == ["dora", "emil", "finn"]
    assert len(reasons) == 8
    assert passed_over([tmp_path], tmp_path / "grades") == (".git",)
    content = read(find_submissions([tmp_path], STEP, tmp_path / "grades")[-2], find_exercise(STEP), "emil")
    assert isinstance(content, Refused)


def test_an_output_folder_that_is_a_link_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "anna").mkdir()
    (tmp_path / "grades").symlink_to(tmp_path)
    assert names(tmp_path) == [("anna", STEP, "anna")]


def test_a_clone_is_one_submission(tmp_path: Path) -> None:
    for name, folders in {"ann": ("course", "docs"), "ben": (".git", "notes")}.items():
        copy_solution(STEP, tmp_path / name / "exercises" / STEP / "my_robot_controller")
        for folder in folders:
            (tmp_path / name / folder).mkdir()
        (found,) = find_submissions([tmp_path / name], STEP, tmp_path / "grades")
        assert found.path == tmp_path / name / "exercises" / STEP


def test_a_link_to_the_exercise_of_another_student_is_not_followed(tmp_path: Path) -> None:
    copy_solution(STEP, tmp_path / "anna" / "exercises" / STEP / "my_robot_controller")
    (tmp_path / "ben").mkdir()
    (tmp_path / "ben" / "exercises").symlink_to(tmp_path / "anna" / "exercises")
    found = find_submissions([tmp_path], STEP, tmp_path / "grades")[1]
    assert isinstance(read(found, find_exercise(STEP), "ben"), Refused)


@pytest.mark.parametrize("inside", [["my_robot_controller"], [STEP], ["01-first-node", STEP]])
def test_the_folders_of_students_are_not_classes(tmp_path: Path, inside: list[str]) -> None:
    """As with `grader grade submitted/*`."""
    students = [tmp_path / name for name in ("anna", "ben")]
    for student in students:
        for name in inside:
            (student / name).mkdir(parents=True)
    with pytest.raises(UsageError, match=f"contains the folders of the students: {tmp_path}$"):
        find_submissions(students, STEP, tmp_path / "grades")
    (tmp_path / "ben" / "clara").mkdir()
    assert len(find_submissions(students, STEP, tmp_path / "grades")) > 1


def test_two_submissions_of_one_student_are_a_usage_error(tmp_path: Path) -> None:
    (tmp_path / "anna").mkdir()
    (tmp_path / "anna.zip").touch()
    (tmp_path / "ben").mkdir()
    anna, ben = find_submissions([tmp_path], STEP, tmp_path / "grades")
    assert anna.refused is not None
    assert anna.refused.reason.startswith("anna has 2 submissions: anna and anna.zip.")
    assert (ben.student, ben.refused) == ("ben", None)


def test_a_package_or_an_archive_alone_is_one_submission(tmp_path: Path) -> None:
    copy_solution(STEP, tmp_path / "anna")
    copy_solution(STEP, tmp_path / "anna/my_robot_controller/my_robot_controller")  # a copy of the package inside it
    copy_solution(STEP, tmp_path / "anna/build/my_robot_controller")
    zipped(tmp_path / "anna", tmp_path / "ben.zip", "my_robot_controller")
    found = find_submissions([tmp_path / "anna", tmp_path / "ben.zip"], STEP, tmp_path / "grades")
    assert [each.student for each in found] == ["anna", "ben"]


@pytest.mark.parametrize("loose", [["setup.py"], ["package.xml"], ["setup.py", "package.xml"]])
def test_no_loose_file_of_a_package_hides_the_class(tmp_path: Path, loose: list[str]) -> None:
    for student in ("anna", "ben"):
        copy_solution(STEP, tmp_path / student / "my_robot_controller")
    for name in loose:
        (tmp_path / name).touch()
    assert [student for student, *_ in names(tmp_path, STEP)] == ["anna", "ben"]


def test_results_inside_a_submission_are_refused(tmp_path: Path) -> None:
    """A student could hand in a folder with forged results, and the grader would keep them."""
    copy_solution(STEP, tmp_path / "exercises" / STEP)
    with pytest.raises(UsageError, match="forged results"):
        find_submissions([tmp_path], STEP, tmp_path / "grades")


def test_results_are_not_submissions(tmp_path: Path) -> None:
    copy_solution(STEP, tmp_path / "anna")
    with results.opened(tmp_path / "older"):
        pass
    assert names(tmp_path) == [("anna", STEP, "anna")]
    assert passed_over([tmp_path], tmp_path / "grades") == ()
    with pytest.raises(UsageError, match=r"older contains results of `grader grade`, and not submissions"):
        find_submissions([tmp_path / "older"], STEP, tmp_path / "grades")


def test_forged_results_are_submissions(tmp_path: Path) -> None:
    """Otherwise, a student could avoid being graded."""
    with results.opened(tmp_path / "older"):
        pass
    (tmp_path / "ben").mkdir()
    (tmp_path / "ben" / MARK).write_text("0" * 32)
    (tmp_path / "carl").mkdir()
    (tmp_path / "carl" / MARK).symlink_to(tmp_path / "older" / MARK)
    (tmp_path / "dora").symlink_to(tmp_path / "older")
    assert [student for student, _, _ in names(tmp_path)] == ["ben", "carl", "dora"]


def test_an_archive_alone_in_a_students_folder_is_the_submission(tmp_path: Path) -> None:
    copy_solution(STEP, tmp_path / "made")
    (tmp_path / "Anna_123_assignsubmission_file").mkdir()
    zipped(tmp_path / "made", tmp_path / "Anna_123_assignsubmission_file" / "work.zip", "my_robot_controller")
    found = Found("anna", STEP, tmp_path / "Anna_123_assignsubmission_file")
    content = read(found, find_exercise(STEP), "anna")
    assert not isinstance(content, Refused)
    assert "package.xml" in content.files


def test_answers_are_found_below_a_folder(tmp_path: Path) -> None:
    copy_solution("02-discover-topics", tmp_path / "made" / "02")
    zipped(tmp_path / "made", tmp_path / "anna.zip", "work")
    content = read(Found("anna", "02-discover-topics", tmp_path / "anna.zip"), find_exercise("02"), "anna")
    assert not isinstance(content, Refused)
    assert list(content.files) == ["answers.toml"]


@pytest.mark.parametrize("change", ["content", "mode", "new file"])
def test_the_fingerprint_changes_only_with_files_that_are_read(tmp_path: Path, change: str) -> None:
    copy_solution(STEP, tmp_path / "anna")
    exercise, found = find_exercise(STEP), Found("anna", STEP, tmp_path / "anna")
    before = fingerprint(found, exercise)
    (tmp_path / "anna" / "build").mkdir()
    (tmp_path / "anna" / "build" / "left.txt").write_text("of colcon")
    assert fingerprint(found, exercise) == before
    file = tmp_path / "anna" / "setup.py"
    if change == "content":
        file.write_text(file.read_text() + "\n")
    elif change == "mode":
        file.chmod(0o755 if not file.stat().st_mode & 0o100 else 0o644)
    else:
        (tmp_path / "anna" / "more.py").touch()
    assert fingerprint(found, exercise) != before


def test_an_entry_that_is_almost_named_like_an_exercise_is_reported(tmp_path: Path) -> None:
    for name in ("erik/02-discover-topics", "erik/03-Circle-Publisher", "anna/03-circle-publisher"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "anna" / "03-circle-publisher (1)").mkdir()  # the right folder exists
    found = find_submissions([tmp_path], None, tmp_path / "out")
    assert [(each.student, each.exercise, bool(each.refused)) for each in found] == [
        ("anna", "03-circle-publisher", False),
        ("erik", "02-discover-topics", False),
        ("erik", "03-circle-publisher", True),
    ]
    assert found[-1].refused is not None
    assert "erik/03-Circle-Publisher must be a folder with the name 03-circle-publisher" in found[-1].refused.reason


def test_a_folder_with_many_entries_does_not_make_the_others_wait(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[None] = []

    def counted() -> dict[str, Path]:
        asked.append(None)
        return catalogue()

    monkeypatch.setattr("grader.classroom.find_submissions.catalogue", counted)
    monkeypatch.setattr("grader.classroom.find_submissions.MAX_ENTRIES", 60)
    for student, entries in (("anna", 50), ("mallory", 70)):
        (tmp_path / student / STEP).mkdir(parents=True)
        for number in range(entries):
            (tmp_path / student / f"02-discover-topics-{number}").touch()
    found = find_submissions([tmp_path], None, tmp_path / "out")
    assert {(each.student, each.exercise, bool(each.refused)) for each in found} == {
        ("anna", "02-discover-topics", True),
        ("anna", STEP, False),
        ("mallory", STEP, False),
    }
    assert len(asked) < 20  # the catalogue is read from the disk


def test_what_nbgrader_does_not_see_is_listed(tmp_path: Path) -> None:
    for name in ("anna/03-circle-publisher", "erik/03-Circle-Publisher", "gina", "hugo/homework", "ines/x"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "fay o.zip").write_bytes(b"")
    (tmp_path / "jon").mkdir()
    (tmp_path / "jon" / "03-circle-publisher.zip").write_bytes(b"")
    (tmp_path / "link").symlink_to("anna")
    (tmp_path / "kim").mkdir()
    (tmp_path / "kim" / "03-circle-publisher").symlink_to(tmp_path / "anna" / "03-circle-publisher")
    (tmp_path / ".gitkeep").write_bytes(b"")
    listed = {each.student: each.refused.reason for each in left_out(tmp_path, ["homework"]) if each.refused}
    assert listed.keys() == {"erik", "fay o", "gina", "ines", "jon", "kim", "link"}
    assert "must be a folder with the name 03-circle-publisher" in listed["erik"]
    assert "must be unpacked" in listed["fay o"]
    assert "must be a folder with the name 03-circle-publisher" in listed["jon"]
    assert "Replace the symbolic link" in listed["kim"]
    assert "symbolic link" in listed["link"]
