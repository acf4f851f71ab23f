"""The reasons why setuptools cannot read an entry point."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.edit import applied
from grader.tests.checks.changed import POINT, of, setup_py
from grader.tests.checks.made import BUILD

FAILED = replace(BUILD, exit_code=1, package=None, installed=(), executables=(), entry_points={})
GENERAL = "Check the entry point character by character: = and : must each appear once."


@pytest.mark.parametrize(
    ("point", "diagnosis", "cause"),
    [
        ("draw_circle my_robot_controller.draw_circle:main", "entry-point-format", GENERAL),
        ("draw_circle == my_robot_controller.draw_circle:main", "entry-point-format", GENERAL),
        ("draw_circle = my_robot_controller:draw_circle:main", "entry-point-format", GENERAL),
        (
            "draw_circle = my-robot-controller.draw_circle:main",
            "entry-point-format",
            "A module name cannot contain a hyphen. Use underscores in the names of Python files and folders.",
        ),
        (
            "draw_circle = my_robot_controller/draw_circle:main",
            "entry-point-slash",
            "The entry point contains a file path. A module name has a dot between folder and file.",
        ),
        (
            "draw_circle = my_robot_controller.draw_circle:main()",
            "entry-point-format",
            "An entry point names a function but does not call the function: leave out the parentheses.",
        ),
        (
            "draw_circle = my_robot_controller.draw_circle.",
            "entry-point-no-function",
            "The entry point does not name a function. After the module, write a colon and the function name.",
        ),
        (
            "draw_circle = a.b:mainother = a.c:main",
            "entry-point-comma",
            "This string contains more than one entry point. Write one string for each, with a comma after it.",
        ),
    ],
)
def test_each_mistake_in_an_entry_point_has_its_own_sentence(point: str, diagnosis: str, cause: str) -> None:
    found = of("build", setup_py(POINT, point), FAILED)
    assert (found.diagnosis, str(found.where), found.cause) == (diagnosis, "setup.py:14", cause)
    assert found.observed == f'setuptools cannot read the entry point "{point}".'
    assert "setuptools cannot read the entry point" not in of("build", build=FAILED).observed


@pytest.mark.parametrize(
    ("point", "right"),
    [
        ("draw_circle = my-robot-controller.draw_circle:main", POINT),
        ("draw_circle = my_robot_controller/draw_circle:main", POINT),
        ("draw_circle = my_robot_controller.draw_circle:main()", POINT),
    ],
)
def test_the_fix_of_an_entry_point_is_the_right_one(point: str, right: str) -> None:
    files = {path: str(text).encode() for path, text in setup_py(POINT, point).items()}
    changed = applied(files, of("build", setup_py(POINT, point), FAILED).fix)
    assert changed is not None
    assert right in changed["setup.py"].decode()


@pytest.mark.parametrize(("new", "told"), [('{"a": "b:main"}', True), ('["a = b:main"]', False)])
def test_console_scripts_is_a_list(new: str, *, told: bool) -> None:
    files = setup_py(f'[\n            "{POINT}",\n        ]', new)
    given = of("build", files, replace(FAILED, log="RuntimeError: setup() was never called\n"))
    assert ("setuptools cannot read console_scripts." in given.observed) == told
    assert ("Here, console_scripts is a dictionary. Write square brackets, and one string" in given.cause) == told
    assert ("console_scripts is a list of strings of the form NAME" in given.expected) == told
