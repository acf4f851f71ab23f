"""The reasons why a student's test file cannot be imported, each with the line of the import."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_test_import import shown_error, why_test_import
from grader.submission.pytest_files import read_test_code
from grader.submission.where import Where

FILE = "test/test_guard.py"
NODE = ("my_robot_controller.wall_guard", "WallGuard")
RIGHT = (
    "The node is in the module my_robot_controller.wall_guard: from my_robot_controller.wall_guard import WallGuard."
)
NO_MODULE = "No module with that name is installed. Check the name letter by letter."


@pytest.mark.parametrize(
    ("line", "error", "words"),
    [
        ("from wall_guard import WallGuard", "ModuleNotFoundError: No module named 'wall_guard'", RIGHT),
        ("from a.wall_gard import WallGuard", "ModuleNotFoundError: No module named 'a.wall_gard'", RIGHT),
        ("from src.a.wall_guard import WallGuard", "ModuleNotFoundError: No module named 'src'", RIGHT),
        (
            "from my_robot_controller.wall_guard import Wallguard",
            "ImportError: cannot import name 'Wallguard' from 'my_robot_controller.wall_guard' (/ws/wall_guard.py)",
            RIGHT,
        ),
        ("import torch", "ModuleNotFoundError: No module named 'torch'", NO_MODULE),
        (
            "from turtlesim.msg import Twist",
            "ImportError: cannot import name 'Twist' from 'turtlesim.msg' (/x/__init__.py)",
            "Python could not do this import. The message of the exception gives the reason.",
        ),
    ],
)
def test_the_exception_and_the_name_of_the_node_decide(line: str, error: str, words: str) -> None:
    code = read_test_code({FILE: f"import os\n{line}\n".encode()}, "my_package")
    cause = why_test_import(error, code, NODE, Where(FILE))
    assert cause.text == words
    assert cause.where == Where(FILE, 2)


def test_a_relative_import_needs_the_name_of_the_package() -> None:
    code = read_test_code({FILE: b"from ..a.wall_guard import WallGuard\n"}, "my_package")
    error = "ImportError: attempted relative import with no known parent package"
    assert why_test_import(error, code, NODE, Where(FILE, 1)).text == RIGHT


@pytest.mark.parametrize(
    ("error", "shown"),
    [
        (
            "ImportError: cannot import name 'A' from 'b' (/home/me/b.py)",
            "ImportError: cannot import name 'A' from 'b'",
        ),
        ("NameError: name 'fixture' is not defined", "NameError: name 'fixture' is not defined"),
    ],
)
def test_no_path_of_the_machine_is_shown(error: str, shown: str) -> None:
    assert shown_error(error) == shown
