"""`ros2 pkg create` creates a package with the same files as the real `ros2`."""

from __future__ import annotations

import re
import stat
from pathlib import Path

import pytest

from grader.tests.ros2.world import World, environment, golden


@pytest.fixture
def src(tmp_path: Path) -> Path:
    """Create the folder and the e-mail address with which the real packages were created."""
    (tmp_path / ".gitconfig").write_text("[user]\nemail = student@example.com\n")
    folder = tmp_path / "ros2_ws/src"
    folder.mkdir(parents=True)
    return folder


def create(src: Path, command: str) -> tuple[str, str, int]:
    env = environment(src.parents[1])
    done = World(src, env).run(f"umask 022; {command}")
    return done.stdout.replace(str(src), "/home/student/ros2_ws/src"), done.stderr, done.code


def test_create_a_package_and_again(src: Path) -> None:
    expected = golden("pkg_create_ament_python")
    assert create(src, expected.command) == (expected.stdout, expected.stderr, expected.code)
    again = golden("pkg_create_again")
    assert create(src, again.command) == (again.stdout, again.stderr, again.code)


def tree(folder: Path) -> set[str]:
    """Return the kind, mode and name of each file and folder, and whether a file is empty.

    Sizes are compared only with 0, because the texts of our files differ from the texts of the real files.
    """
    lines = set()
    for path in [folder, *folder.rglob("*")]:
        mode = path.stat().st_mode
        size = "-" if path.is_dir() or path.stat().st_size else "0"
        lines.add(f"{'d' if path.is_dir() else 'f'} {stat.S_IMODE(mode):o} {size} {path.relative_to(folder.parent)}")
    return lines


def test_new_packages_contain_the_same_files_as_the_real_ones(src: Path) -> None:
    recorded = (Path(__file__).parents[1] / "golden/ros2/pkg_create_tree_and_files.txt").read_text()
    parts = re.split(r"^##### (.*)\n", recorded, flags=re.MULTILINE)[1:]
    expected = dict(zip(parts[::2], parts[1::2], strict=True))
    assert create(src, golden("pkg_create_ament_python").command)[2] == 0
    # The other tree was created with this command of the ROS 2 tutorial.
    book = "ros2 pkg create --build-type ament_python --license Apache-2.0 --node-name my_node my_package"
    assert create(src, book)[2] == 0
    for title, text in expected.items():
        if title.startswith("tree "):
            listed = re.sub(
                r"^([df] \d+) (\d+) ", lambda m: f"{m[1]} {'-' if int(m[2]) else 0} ", text, flags=re.MULTILINE
            )
            assert tree(src / title.removeprefix("tree ")) == set(listed.splitlines())
        else:
            assert (src / title).read_text() == text, title
