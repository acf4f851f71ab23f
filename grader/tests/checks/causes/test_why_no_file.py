"""Files that a node opens and that do not exist, each with a package that is nearly the same."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported

WRITTEN = "/home/ana/ros2_ws/src/my_robot_controller/config/circle.yaml"
OWN = {"config/circle.yaml": ""}


@pytest.mark.parametrize(
    ("path", "files", "words"),
    [
        (WRITTEN, OWN, "The code contains an absolute path, which does not exist on every computer. Install the file"),
        ("/ws/site-packages/config/circle.yaml", OWN, "contains config/circle.yaml, but not at this path. Install"),
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
        f'PATH = "{WRITTEN}"\nopen(path)  # crashed\n',
        f"FileNotFoundError: [Errno 2] No such file or directory: '{path}'",
        files,
    )
    told = found.diagnosis == "file-not-installed"
    assert (words in found.cause, told) == (True, bool(words))
