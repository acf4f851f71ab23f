from __future__ import annotations

import json
import zipfile
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.classroom.content import read
from grader.classroom.found import Found
from grader.classroom.refused import Refused
from grader.errors import UsageError
from grader.exercise.model import course_folder
from grader.submission.handed_in import open_handed_in

if TYPE_CHECKING:
    from pathlib import Path

CIRCLE = find_exercise("03")
PACKAGE = "my_robot_controller"
NODE = f"{PACKAGE}/{PACKAGE}/draw_circle.py"
FILE = f"{PACKAGE}/draw_circle.py"
START = course_folder().parent / "exercises" / CIRCLE.id


def handed_in(folder: Path, cell: str, files: dict[str, str], notebook: str = f"{CIRCLE.id}.ipynb") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    cells = [{"cell_type": "code", "source": f"%%node draw_circle.py\n{cell}"}]
    (folder / notebook).write_text(json.dumps({"cells": cells}))
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    return folder


def start(path: str) -> str:
    return (START / path).read_text("utf-8")


def node_of(folder: Path) -> str:
    """Return the node that is graded. `grader grade` and `grader check` read the same files."""
    opened = open_handed_in(folder, CIRCLE)
    of_class = read(Found("anna", CIRCLE.id, folder), CIRCLE, "anna")
    assert of_class == replace(opened, name="anna", student="anna")
    return opened.files[FILE].decode()


@pytest.mark.parametrize(
    ("cell", "node", "graded"),
    [
        ("mine\n", start(NODE), "mine\n"),  # the cell was changed, but never executed
        ("mine\n", "edited later\n", "edited later\n"),  # the file was changed
        (start(NODE), "mine\n", "mine\n"),  # only the file was changed
        ("mine\n", start(NODE).replace("\n", "\r\n"), "mine\n"),  # only the line ends of the file were changed
    ],
)
def test_which_text_is_graded(tmp_path: Path, cell: str, node: str, graded: str) -> None:
    package = f"{PACKAGE}/package.xml"
    submitted = handed_in(tmp_path / "in", cell, {NODE: node, package: start(package)})
    assert node_of(submitted) == graded
    files = open_handed_in(submitted, CIRCLE).files
    assert files.keys() == {FILE, "package.xml"}
    assert files["package.xml"].decode() == start(package)


def test_a_notebook_alone_is_completed_with_the_starting_point(tmp_path: Path) -> None:
    submitted = handed_in(tmp_path / "in", "mine", {})
    assert node_of(submitted) == "mine\n"
    opened = open_handed_in(submitted, CIRCLE)
    assert opened.files["setup.py"].decode() == start(f"{PACKAGE}/setup.py")
    assert opened.package_dir == submitted / PACKAGE


def test_a_cell_that_cannot_be_a_file_does_not_count(tmp_path: Path) -> None:
    submitted = handed_in(tmp_path / "in", "mine", {})
    notebook = submitted / f"{CIRCLE.id}.ipynb"
    cells = json.loads(notebook.read_text())["cells"]
    for source in ("%%node half.py\n# \ud83d", "%%package a\0b\n"):
        cells.append({"cell_type": "code", "source": source})
    notebook.write_text(json.dumps({"cells": cells}))
    assert node_of(submitted) == "mine\n"


def test_an_unchanged_notebook_is_not_a_package(tmp_path: Path) -> None:
    submitted = handed_in(tmp_path / "in", start(NODE), {})
    assert "no cell that begins with %%node or %%package differs from the starting point" in why_no_package(submitted)


def why_no_package(folder: Path) -> str:
    with pytest.raises(UsageError, match="There is no package") as error:
        open_handed_in(folder, CIRCLE)
    return str(error.value)


def test_why_a_notebook_does_not_replace_the_package_is_told(tmp_path: Path) -> None:
    other = handed_in(tmp_path / "other", "mine", {}, "06-pose-subscriber.ipynb")
    assert f"06-pose-subscriber.ipynb is the notebook of 06-pose-subscriber, not of {CIRCLE.id}." in why_no_package(
        other
    )
    broken = handed_in(tmp_path / "broken", "mine", {})
    (broken / f"{CIRCLE.id}.ipynb").write_text("{")
    assert f"{CIRCLE.id}.ipynb could not be read as a notebook." in why_no_package(broken)
    several = handed_in(tmp_path / "several", "one", {}, "a.ipynb")
    handed_in(several, "two", {}, "b.ipynb")
    assert "The cells of a.ipynb and b.ipynb were not used" in why_no_package(several)


def test_the_cells_of_a_notebook_in_an_archive_count(tmp_path: Path) -> None:
    submitted = handed_in(tmp_path / "in", "mine", {})
    with zipfile.ZipFile(tmp_path / "anna.zip", "w") as archive:
        archive.write(submitted / f"{CIRCLE.id}.ipynb", f"hand-in/{CIRCLE.id}/{CIRCLE.id}.ipynb")
    content = read(Found("anna", CIRCLE.id, tmp_path / "anna.zip"), CIRCLE, "anna")
    assert not isinstance(content, Refused)
    assert content.files[FILE] == b"mine\n"


@pytest.mark.parametrize("notebook", [f"{CIRCLE.id} (1).ipynb", "Untitled.ipynb"])
@pytest.mark.parametrize("below", ["", "again", "ros2_ws/src"])
def test_a_renamed_or_nested_notebook_counts(tmp_path: Path, notebook: str, below: str) -> None:
    handed_in(tmp_path / "in" / below, "mine", {NODE: start(NODE), f"{PACKAGE}/package.xml": "x"}, notebook)
    assert node_of(tmp_path / "in") == "mine\n"


def test_a_notebook_above_the_package_counts(tmp_path: Path) -> None:
    folder = handed_in(tmp_path / "in", "mine", {f"src/{NODE}": start(NODE), f"src/{PACKAGE}/package.xml": "x"})
    assert node_of(folder) == "mine\n"


def test_notebooks_whose_cells_are_not_used_are_named(tmp_path: Path) -> None:
    files = {NODE: start(NODE), f"{PACKAGE}/package.xml": "x"}
    one = handed_in(tmp_path / "in", "one", files, f"{CIRCLE.id} (1).ipynb")
    handed_in(one, "two", {}, f"{CIRCLE.id} (2).ipynb")
    handed_in(one, "another step", {}, "06-pose-subscriber.ipynb")
    assert node_of(one) == start(NODE)
    remark = open_handed_in(one, CIRCLE).remark
    assert f"The cells of {CIRCLE.id} (1).ipynb and {CIRCLE.id} (2).ipynb were not used" in remark

    # The notebook with the name of the exercise comes first.
    handed_in(one, "three", {})
    assert node_of(one) == "three\n"
    assert open_handed_in(one, CIRCLE).remark == remark


def test_nothing_is_read_through_a_link_that_leads_away(tmp_path: Path) -> None:
    submitted = handed_in(tmp_path / "in", "mine", {f"{PACKAGE}/package.xml": "x"})
    (submitted / PACKAGE / PACKAGE).symlink_to(tmp_path)
    assert FILE not in open_handed_in(submitted, CIRCLE).files
    assert not (tmp_path / "draw_circle.py").exists()
    other = handed_in(tmp_path / "other", "theirs", {})
    linked = handed_in(tmp_path / "linked", "", {NODE: start(NODE), f"{PACKAGE}/package.xml": "x"})
    (linked / f"{CIRCLE.id}.ipynb").unlink()
    (linked / f"{CIRCLE.id}.ipynb").symlink_to(other / f"{CIRCLE.id}.ipynb")
    assert node_of(linked) == start(NODE)


@pytest.mark.parametrize("text", ["no json", "[]", '{"cells": 7}', '{"cells": [{"cell_type": "code"}]}'])
def test_a_broken_notebook_does_not_stop_the_grading(tmp_path: Path, text: str) -> None:
    submitted = handed_in(tmp_path / "in", "", {NODE: "mine\n", f"{PACKAGE}/package.xml": "x"})
    (submitted / f"{CIRCLE.id}.ipynb").write_text(text)
    assert node_of(submitted) == "mine\n"
    assert open_handed_in(submitted, CIRCLE).remark == f"{CIRCLE.id}.ipynb could not be read as a notebook."
    (submitted / f"{CIRCLE.id} (1).ipynb").write_text(text)
    assert open_handed_in(submitted, CIRCLE).remark == (
        f"{CIRCLE.id} (1).ipynb and {CIRCLE.id}.ipynb could not be read as notebooks."
    )
