"""The predicted install tree has the files that colcon installs, and the comparison notices every difference."""

from __future__ import annotations

import io
import tarfile
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.colcon import runner
from grader.colcon.comparison import installs
from grader.colcon.predicted import PYTHON, predict
from grader.ros.installation import find_ros
from grader.sandbox import bubblewrap
from grader.submission.package import open_submission
from grader.tests.case import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from grader.colcon.predicted import Predicted
    from grader.submission.package import Submission

STEP = ROOT / "solutions/03-circle-publisher"
NAME = "my_robot_controller"
NODE = f"{NAME}/draw_circle.py"
NODES = ("draw_circle", "test_node")


@pytest.fixture(scope="module")
def package() -> Submission:
    """Return a package with everything that a usual package may contain, such as a subpackage and data files."""
    given = open_submission(STEP)
    setup_py = given.files["setup.py"].decode()
    setup_py = setup_py.replace('["package.xml"]', '["package.xml", "config/a.yaml", "config/run.sh"]')
    more = {
        "setup.py": setup_py.encode(),
        f"{NAME}/sea/__init__.py": b"",
        f"{NAME}/sea/fish.py": b"DEPTH = 3\n",
        f"{NAME}/notes.txt": b"not installed\n",
        "config/a.yaml": b"a: 1\n",
        "config/run.sh": b"#!/bin/sh\n",
        "test/__init__.py": b"",
        "test/test_fish.py": b"",
    }
    return replace(given, files={**given.files, **more}, executable=frozenset({"config/run.sh", NODE}))


@pytest.fixture(scope="module")
def predicted(package: Submission) -> Predicted:
    found = predict(package, find_ros(), NODES)
    assert found is not None
    return found


@pytest.fixture(scope="module")
def tree(package: Submission) -> bytes:
    built = runner.build(package, find_ros(), in_cell=bubblewrap.usable(), tell=lambda _: None)
    assert built.build.exit_code == 0, built.build.log
    return built.tree


def changed(tree: bytes, change: Callable[[tarfile.TarInfo, bytes], Iterator[tuple[tarfile.TarInfo, bytes]]]) -> bytes:
    """Return the tree in which every member is replaced by the members that `change` yields."""
    stream = io.BytesIO()
    with (
        tarfile.open(fileobj=io.BytesIO(tree)) as old,
        tarfile.open(fileobj=stream, mode="w", format=tarfile.GNU_FORMAT) as new,
    ):
        for member in old:
            file = old.extractfile(member)
            for each, content in change(member, file.read() if file else b""):
                each.size = len(content)
                new.addfile(each, io.BytesIO(content))
    return stream.getvalue()


def test_colcon_installs_the_predicted_files(tree: bytes, predicted: Predicted) -> None:
    assert installs(tree, predicted)
    assert {path.rpartition("/")[2] for path in predicted.files} >= {"a.yaml", "run.sh", "fish.py", *NODES}
    assert not [path for path in predicted.files if path.endswith(("notes.txt", "test_fish.py"))]


def test_a_comparison_does_not_need_the_predicted_tree_itself_to_be_complete(predicted: Predicted) -> None:
    """A tree without folders and without the files that colcon adds differs from every install tree of colcon."""
    assert not installs(predicted.tree, predicted)


@pytest.mark.parametrize("file", ["draw_circle.py", "draw_circle", "entry_points.txt", "package.xml", "a.yaml"])
def test_a_changed_file_is_noticed(tree: bytes, predicted: Predicted, file: str) -> None:
    def other_content(member: tarfile.TarInfo, content: bytes) -> Iterator[tuple[tarfile.TarInfo, bytes]]:
        yield member, content + b"#" if member.name.endswith(f"/{file}") else content

    def other_mode(member: tarfile.TarInfo, content: bytes) -> Iterator[tuple[tarfile.TarInfo, bytes]]:
        member.mode ^= 0o100 if member.name.endswith(f"/{file}") else 0
        yield member, content

    def missing(member: tarfile.TarInfo, content: bytes) -> Iterator[tuple[tarfile.TarInfo, bytes]]:
        if not member.name.endswith(f"/{file}"):
            yield member, content

    def link(member: tarfile.TarInfo, content: bytes) -> Iterator[tuple[tarfile.TarInfo, bytes]]:
        if member.name.endswith(f"/{file}"):
            member.type, member.linkname, content = tarfile.SYMTYPE, "elsewhere", b""
        yield member, content

    assert installs(changed(tree, lambda *member: iter([member])), predicted)
    for change in (other_content, other_mode, missing, link):
        assert not installs(changed(tree, change), predicted), change.__name__


@pytest.mark.parametrize(
    "path",
    [
        f"{NAME}/lib/{NAME}/rclpy.py",
        f"{NAME}/lib/python{PYTHON}/site-packages/rclpy.py",
        f"{NAME}/lib/python{PYTHON}/site-packages/a.pth",
        f"{NAME}/lib/python{PYTHON}/site-packages/{NAME}/more.py",
        f"{NAME}/share/{NAME}/b.yaml",
        "rclpy/package.xml",
        "rclpy.py",
    ],
)
def test_an_additional_file_is_noticed(tree: bytes, predicted: Predicted, path: str) -> None:
    def added(member: tarfile.TarInfo, content: bytes) -> Iterator[tuple[tarfile.TarInfo, bytes]]:
        yield member, content
        if member.name == ".":
            yield tarfile.TarInfo(f"./{path}"), b""

    assert not installs(changed(tree, added), predicted)


def test_an_empty_folder_is_noticed(tree: bytes, predicted: Predicted) -> None:
    def added(member: tarfile.TarInfo, content: bytes) -> Iterator[tuple[tarfile.TarInfo, bytes]]:
        yield member, content
        if member.name == ".":
            folder = tarfile.TarInfo(f"./{NAME}/share/empty")
            folder.type, folder.mode = tarfile.DIRTYPE, 0o755
            yield folder, b""

    assert not installs(changed(tree, added), predicted)


@pytest.mark.parametrize("damage", [b"x", b"\1" * 512])
def test_a_damaged_tree_is_not_the_predicted_one(tree: bytes, predicted: Predicted, damage: bytes) -> None:
    assert installs(tree + bytes(512), predicted)
    assert not installs(tree + damage, predicted)
    assert not installs(tree[:5000], predicted)
    assert not installs(b"", predicted)


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        (NODE, b"import rclpy\n", b"import os\nimport rclpy\n"),
        (NODE, b"import rclpy\n", b"import rclpy\n\nprint(__file__)\n"),
        (NODE, b"import rclpy\n", b"import rclpy\n\nprint(rclpy.__path__)\n"),
        (NODE, b"import rclpy\n", b"import rclpy\n\nfor line in open('a.yaml'):\n    print(line)\n"),
        (NODE, b"import rclpy\n", b"import rclpy\nfrom my_robot_controller.sea import os_helper\nimport unknown\n"),
        ("package.xml", b"ament_python", b"ament_cmake"),
        ("package.xml", b"<name>my_", b"<name>your_"),
        ("setup.py", b'"resource/" + package_name', b'"resource/robot"'),
        ("setup.py", b', ["package.xml", ', b', ["packages.xml", '),
        ("setup.cfg", b"[install]", b"[installs]"),
    ],
)
def test_nothing_is_predicted_for_an_unusual_package(package: Submission, path: str, old: bytes, new: bytes) -> None:
    assert old in package.files[path]
    files = {**package.files, path: package.files[path].replace(old, new)}
    assert predict(replace(package, files=files), find_ros(), NODES) is None


@pytest.mark.parametrize("file", ["pyproject.toml", "CMakeLists.txt", "COLCON_IGNORE"])
def test_nothing_is_predicted_for_another_kind_of_package(package: Submission, file: str) -> None:
    assert predict(replace(package, files={**package.files, file: b""}), find_ros(), NODES) is None


def test_only_the_nodes_that_run_need_to_be_usual(package: Submission) -> None:
    files = {**package.files, NODE: b"import os\n" + package.files[NODE]}
    assert predict(replace(package, files=files), find_ros(), ["test_node"]) is not None
    assert predict(replace(package, files=files), find_ros(), ["missing"]) is None
