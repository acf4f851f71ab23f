"""Files that a node opens and that do not exist, each with a package that is nearly the same."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported

OWN = {"config/circle.yaml": ""}


@pytest.mark.parametrize(
    ("path", "files", "words"),
    [
        (
            "/ws/share/my_robot_controller/config/circle.yaml",
            OWN,
            "The build does not install config/circle.yaml there",
        ),
        ("/ws/share/my_robot_controller/config/square.yaml", OWN, ""),
        ("/ws/share/my_robot_controller/config/circle.yaml", {}, ""),
        ("config/circle.yaml", OWN, "a node does not run in the folder of its package. Install the file"),
        ("config/circle.yaml", {}, ""),
        ("my_robot_controller/helper.py", {"my_robot_controller/helper.py": ""}, ""),
    ],
)
def test_a_file_of_the_package_is_named(path: str, files: dict[str, str], words: str) -> None:
    found = reported(
        "open(path)  # crashed\n", f"FileNotFoundError: [Errno 2] No such file or directory: '{path}'", files
    )
    told = "does not install" in found.cause or "does not run in the folder" in found.cause
    assert (words in found.cause, told) == (True, bool(words))
