from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.exercise.model import course_folder
from grader.gradebook.package_from_notebook import graded_folder

if TYPE_CHECKING:
    from pathlib import Path

CIRCLE = find_exercise("03")
NODE = "my_robot_controller/my_robot_controller/draw_circle.py"
START = course_folder().parent / "exercises" / CIRCLE.id


def handed_in(folder: Path, cell: str, files: dict[str, str]) -> Path:
    folder.mkdir()
    cells = [{"cell_type": "code", "source": f"%%node draw_circle.py\n{cell}"}]
    (folder / f"{CIRCLE.id}.ipynb").write_text(json.dumps({"cells": cells}))
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    return folder


def start(path: str) -> str:
    return (START / path).read_text("utf-8")


@pytest.mark.parametrize(
    ("cell", "node", "graded"),
    [
        ("mine\n", start(NODE), "mine\n"),  # the cell was changed, but never executed
        ("mine\n", "edited later\n", "edited later\n"),  # the file was changed
        (start(NODE), "mine\n", "mine\n"),  # only the file was changed
    ],
)
def test_which_text_is_graded(tmp_path: Path, cell: str, node: str, graded: str) -> None:
    package = "my_robot_controller/package.xml"
    submitted = handed_in(tmp_path / "in", cell, {NODE: node, package: start(package)})
    folder = graded_folder(CIRCLE, submitted, tmp_path / "out")
    assert (folder / NODE).read_text() == graded
    assert (folder / package).read_text() == start(package)
    assert not (folder == tmp_path / "out" and (folder / f"{CIRCLE.id}.ipynb").exists())


def test_a_notebook_alone_is_completed_with_the_starting_point(tmp_path: Path) -> None:
    folder = graded_folder(CIRCLE, handed_in(tmp_path / "in", "mine", {}), tmp_path / "out")
    assert (folder / NODE).read_text() == "mine\n"
    assert (folder / "my_robot_controller/setup.py").read_text() == start("my_robot_controller/setup.py")


def test_an_unchanged_notebook_is_not_a_package(tmp_path: Path) -> None:
    submitted = handed_in(tmp_path / "in", start(NODE), {})
    assert graded_folder(CIRCLE, submitted, tmp_path / "out") == submitted


def test_an_earlier_completed_folder_is_replaced(tmp_path: Path) -> None:
    submitted = handed_in(tmp_path / "in", "mine", {})
    assert graded_folder(CIRCLE, submitted, tmp_path / "out") == tmp_path / "out"
    (submitted / f"{CIRCLE.id}.ipynb").unlink()
    assert graded_folder(CIRCLE, submitted, tmp_path / "out") == submitted
    assert not (tmp_path / "out").exists()


def test_nothing_is_written_through_a_link_that_leads_away(tmp_path: Path) -> None:
    submitted = handed_in(tmp_path / "in", "mine", {"my_robot_controller/package.xml": "x"})
    (submitted / "my_robot_controller" / "my_robot_controller").symlink_to(tmp_path)
    assert graded_folder(CIRCLE, submitted, tmp_path / "out") == submitted
    assert not (tmp_path / "draw_circle.py").exists()


@pytest.mark.parametrize("text", ["no json", "[]", '{"cells": 7}', '{"cells": [{"cell_type": "code"}]}'])
def test_a_broken_notebook_does_not_stop_the_grading(tmp_path: Path, text: str) -> None:
    submitted = handed_in(tmp_path / "in", "", {"my_robot_controller/package.xml": "x"})
    (submitted / f"{CIRCLE.id}.ipynb").write_text(text)
    assert graded_folder(CIRCLE, submitted, tmp_path / "out") == submitted
