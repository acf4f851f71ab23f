from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from grader.checks.exercises import find_exercise
from grader.errors import UsageError
from grader.exercise.starting_point import starting_point
from grader.notebook import cell_files
from grader.notebook.cell_files import begin
from grader.notebook.cells import Cells
from grader.submission.notebook_cells import Part, counts, part_path, parts_of

CIRCLE = find_exercise("03")
ANSWERS = find_exercise("02")
CHALLENGES = find_exercise("07")


@pytest.mark.parametrize(
    ("magic", "name", "path"),
    [
        ("node", "draw_circle.py", "my_robot_controller/my_robot_controller/draw_circle.py"),
        ("package", "package.xml", "my_robot_controller/package.xml"),
        ("answers", "", "my_robot_controller/answers.toml"),
    ],
)
def test_a_cell_writes_into_the_package(magic: str, name: str, path: str) -> None:
    assert part_path(magic, name, CIRCLE) == path


def test_without_a_package_answers_are_next_to_the_notebook() -> None:
    assert part_path("answers", "", ANSWERS) == "answers.toml"
    with pytest.raises(UsageError, match="has no package"):
        part_path("node", "a.py", ANSWERS)


@pytest.mark.parametrize(
    ("magic", "name"),
    [
        ("node", "../a.py"),
        ("node", "a"),
        ("node", ""),
        ("node", "1a.py"),
        ("package", "../x"),
        ("package", "/etc/x"),
        ("package", "a/../../x"),
        ("package", "."),
    ],
)
def test_nothing_is_written_outside_of_the_folder(magic: str, name: str) -> None:
    with pytest.raises(UsageError, match=f"%%{magic} needs"):
        part_path(magic, name, CIRCLE)


def test_the_files_of_a_notebook_are_read_from_its_cells() -> None:
    node = "my_robot_controller/my_robot_controller/a.py"
    cells = [
        "%%node a.py\nold",
        "print(1)",
        "%%node ../b.py\nx",
        "  %%node a.py  \nnew\n\n",
        "%%nodes a.py\nx",
        "%%node",
    ]
    assert parts_of(cells, CIRCLE) == [Part(node, "new\n")]


@pytest.mark.parametrize(
    ("file", "start", "what"),
    [
        (None, "start", "cell"),
        (None, None, "cell"),
        ("start\n", "start", "cell"),
        ("mine", "start", "file"),
        ("mine", None, "file"),
    ],
)
def test_a_file_counts_if_the_student_changed_it(file: str | None, start: str | None, what: str) -> None:
    assert counts(file, start) == what


@pytest.mark.parametrize(("parent", "kept"), [("exercises", False), ("solutions", True)])
def test_only_the_notebook_of_a_solution_keeps_the_numbers_of_the_starting_point(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, parent: str, kept: bool
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr("getpass.getuser", lambda: "ada")
    folder = tmp_path / parent / CHALLENGES.id
    folder.mkdir(parents=True)
    begin(CHALLENGES, folder)
    assert CHALLENGES.numbers
    numbers = Path(CHALLENGES.package, CHALLENGES.numbers.file)
    given = (starting_point(CHALLENGES) / numbers).read_bytes()
    assert ((folder / numbers).read_bytes() == given) is kept


def test_the_message_about_a_full_disk_names_the_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> tuple[str, ...]:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))  # an error of write() has no file name

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(cell_files, "begin", fail)
    with pytest.raises(UsageError, match=f"^{tmp_path} could not be written: No space left on device\\.$"):
        Cells().step(CIRCLE.id)
