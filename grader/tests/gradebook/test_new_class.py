from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import pytest
from sqlalchemy.exc import SAWarning

from grader.errors import MachineError, UsageError
from grader.gradebook.class_folders import CONFIG, open_class, remember
from grader.gradebook.config import COURSE_ID
from grader.gradebook.new_class import NewClass, course_id, make_class, read_students

if TYPE_CHECKING:
    from pathlib import Path


def roster(folder: Path, text: str) -> Path:
    file = folder / "roster.csv"
    file.write_text(text, encoding="utf-8-sig")
    return file


@pytest.mark.parametrize(
    ("folder", "name"),
    [("ros2-2027", "ros2-2027"), ("ROS 2 (spring)", "ROS-2-spring"), ("Übung.1", "bung.1"), ("龜", COURSE_ID)],
)
def test_a_class_has_a_name_of_its_own_in_the_exchange(folder: str, name: str, tmp_path: Path) -> None:
    assert course_id(tmp_path / folder) == name


def test_a_class_has_its_students_and_no_other_data(tmp_path: Path) -> None:
    file = roster(tmp_path, "id,last_name,first_name,room\nada,Lovelace,Ada,12\nbob,,,\n")
    assert make_class(tmp_path / "new", file) == NewClass(2, "new")
    folders = open_class(tmp_path / "new")  # finds its folder course/
    assert open_class(tmp_path / "new" / "course").course.root == folders.course.root == str(tmp_path / "new")
    assert folders.course.course_id == "new"
    from nbgrader.api import Gradebook

    with Gradebook(folders.course.db_url, folders.course.course_id) as gradebook:
        assert [(s.id, s.first_name, s.last_name) for s in gradebook.students] == [
            ("bob", None, None),
            ("ada", "Ada", "Lovelace"),
        ]
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == [
        "COLCON_IGNORE",
        "class",
        "course",
        "exercises",
        "solutions",
    ]
    with pytest.raises(UsageError, match="is not an empty folder"):
        make_class(tmp_path / "new", file)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("name\nada\n", 'name the column "id"'),
        ("id\nada\n\nb/c\n", 'line 4: the id is "b/c"'),
        ("id\n../ada\n", "nbgrader uses it as a folder name"),
        ("id\na+b\n", "nbgrader uses it as a folder name"),
    ],
)
def test_an_invalid_roster_is_a_usage_error(tmp_path: Path, text: str, why: str) -> None:
    with pytest.raises(UsageError, match=why):
        read_students(roster(tmp_path, text))


def test_a_folder_without_a_course_is_a_usage_error(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"has no nbgrader_config\.py"):
        open_class(tmp_path)


@pytest.fixture
def clone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Create a student's clone of the course as the current folder.

    The clone's configuration file leaves a trace when it is executed.
    """
    folder = tmp_path / "clone"
    (folder / "course").mkdir(parents=True)
    (folder / "course" / CONFIG).write_text(f"open({str(tmp_path / 'touched')!r}, 'w').close()\n")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.chdir(folder)
    return folder


def test_the_configuration_of_an_unknown_folder_is_not_run(clone: Path) -> None:
    for place in (clone, clone / "course"):
        with pytest.MonkeyPatch.context() as patch:
            patch.chdir(place)
            with pytest.raises(UsageError, match=r"nothing shows that .* created this folder for you.*--course "):
                open_class(None)
    assert not (clone.parent / "touched").exists()


def test_a_configuration_runs_if_the_instructor_names_or_made_the_folder(clone: Path) -> None:
    open_class(clone)
    (clone.parent / "touched").unlink()
    remember(clone.parent / "another")
    remember(clone)
    open_class(None)
    assert (clone.parent / "touched").exists()


def test_a_gradebook_without_noise_or_the_reason_why_there_is_none(tmp_path: Path) -> None:
    make_class(tmp_path / "new", None)
    folders = open_class(tmp_path / "new")
    with warnings.catch_warnings(record=True) as shown:
        warnings.simplefilter("always")
        with folders.gradebook():
            warnings.warn("nbgrader's session", SAWarning, stacklevel=1)
    assert [warning for warning in shown if warning.category is SAWarning] == []

    (tmp_path / "new/class/gradebook.db").unlink()
    (tmp_path / "new/class/gradebook.db").mkdir()
    with pytest.raises(MachineError, match="could not be read or written: unable to open database file"):
        folders.gradebook().__enter__()

    (tmp_path / "new/class/gradebook.db").rmdir()
    (tmp_path / "new/class/gradebook.db").write_bytes(b"no database" * 1000)
    with pytest.raises(MachineError, match="could not be read or written: file is not a database"):
        folders.gradebook().__enter__()
