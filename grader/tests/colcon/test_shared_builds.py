"""Submissions that differ only in their modules share one build, and each gets what colcon would have installed."""

from __future__ import annotations

import io
import tarfile
from dataclasses import replace
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

from grader.colcon import runner
from grader.colcon.build import Build
from grader.colcon.comparison import installs
from grader.colcon.predicted import SITE, predict
from grader.colcon.shared_builds import SharedBuilds
from grader.ros.installation import find_ros
from grader.sandbox import bubblewrap
from grader.submission.package import digest, open_submission
from grader.tests.case import ROOT

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.submission.package import Submission

PACKAGE = "my_robot_controller"
NODE = f"{PACKAGE}/draw_circle.py"
TEST = "test/test_node.py"
LONG_NAME = 100
"""Formats of tar store the names that are longer than this (characters) in different ways."""


@pytest.fixture(scope="module")
def solution() -> Submission:
    return with_files(open_submission(ROOT / "solutions/03-circle-publisher"), {TEST: b"def test_node(): ...\n"})


def with_files(submission: Submission, files: Mapping[str, bytes]) -> Submission:
    files = {**submission.files, **files}
    return replace(submission, files=files, digest=digest(files))


def with_node(submission: Submission, text: str) -> Submission:
    return with_files(submission, {NODE: text.encode()})


class Colcon:
    """A build with colcon that remembers the packages. `tree` replaces the install tree of each build."""

    def __init__(self, tree: bytes | None = None) -> None:
        self.packages: list[Submission] = []
        self._tree = tree

    def __call__(self, package: Submission, *arguments: Any, **options: Any) -> runner.Built:  # noqa: ANN401
        self.packages.append(package)
        if self._tree is not None:
            modules = tuple(f"{SITE}/{path}" for path in package.files if path.startswith(f"{PACKAGE}/"))
            return runner.Built(Build(0, "", PACKAGE, installed=modules), self._tree)
        return runner.build(package, *arguments, **options)


@pytest.fixture(scope="module")
def builds(solution: Submission) -> SharedBuilds:
    """Return builds that have built the solution."""
    builds = SharedBuilds()
    build(builds, solution)
    return builds


@pytest.fixture
def surprise() -> bytes:
    """Return an install tree with a file that is not in the package."""
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w") as tar:
        tar.addfile(tarfile.TarInfo("my_robot_controller/share/surprise"))
    return stream.getvalue()


def build(builds: SharedBuilds, submission: Submission) -> runner.Built:
    return builds(submission, find_ros(), in_cell=bubblewrap.usable(), tell=lambda _: None)


def members(tree: bytes) -> dict[str, tuple[int, bytes]]:
    with tarfile.open(fileobj=io.BytesIO(tree)) as tar:
        return {
            member.name: (member.mode, file.read() if (file := tar.extractfile(member)) else member.type)
            for member in tar
        }


def test_modules_do_not_need_a_build_of_their_own(builds: SharedBuilds, solution: Submission) -> None:
    runs = builds.runs
    written = with_node(solution, "def main(args=None):\n    print('hello')\n")
    written = replace(written, package_dir=solution.package_dir.with_name("anna-2"))
    shared = [build(builds, each) for each in (solution, written)]
    assert builds.runs == runs
    own = runner.build(written, find_ros(), in_cell=bubblewrap.usable(), tell=lambda _: None)
    assert members(shared[1].tree) == members(own.tree)
    assert members(shared[0].tree) != members(own.tree)
    assert replace(shared[1].build, seconds=0.0, log="") == replace(own.build, seconds=0.0, log="")


def test_the_files_are_the_predicted_ones(builds: SharedBuilds, solution: Submission) -> None:
    """Otherwise a node that already ran during the build would run again."""
    written = with_node(solution, "def main(args=None):\n    print('hello')\n")
    predicted = predict(written, find_ros(), ())
    assert predicted is not None
    assert any(len(f"{predicted.package}/{path}") > LONG_NAME for path in predicted.files)
    assert installs(build(builds, written).tree, predicted)


def test_only_an_earlier_build_is_called_so(solution: Submission) -> None:
    reported: list[str] = []
    builds = SharedBuilds()
    for _ in range(2):
        builds(solution, find_ros(), in_cell=bubblewrap.usable(), tell=reported.append)
    assert reported == ["Building with colcon", "Using an earlier build: at most the modules differ"]


def test_the_shared_build_contains_no_module_of_a_student(solution: Submission) -> None:
    colcon = Colcon()
    build(SharedBuilds(colcon), solution)
    (package,) = colcon.packages
    assert {path: data for path, data in package.files.items() if path.startswith("my_robot_controller/")} == {
        "my_robot_controller/__init__.py": b"",
        NODE: b"",
        "my_robot_controller/my_first_node.py": b"",
    }
    assert package.files[TEST] == solution.files[TEST]


@pytest.mark.parametrize(
    "change",
    [
        {"package.xml": b"<!-- a comment -->"},
        {"setup.py": b"# a comment\n"},
        {TEST: b"# a comment\n"},
        {"my_robot_controller/another.py": b""},
    ],
    ids=lambda change: next(iter(change)),
)
def test_another_file_needs_another_build(builds: SharedBuilds, solution: Submission, change: dict[str, bytes]) -> None:
    runs = builds.runs
    build(builds, with_files(solution, {path: solution.files.get(path, b"") + text for path, text in change.items()}))
    assert builds.runs == runs + 1


@pytest.mark.parametrize("folder", [".hidden", "Abgabe M\u00fcller", "-p"])
def test_a_package_in_an_unusual_folder_is_built_there(solution: Submission, surprise: bytes, folder: str) -> None:
    colcon = Colcon(surprise)
    package = replace(solution, package_dir=solution.package_dir.with_name(folder))
    build(SharedBuilds(colcon), package)
    assert colcon.packages == [package]


def test_another_permission_needs_another_build(builds: SharedBuilds, solution: Submission) -> None:
    runs = builds.runs
    build(builds, replace(solution, executable=frozenset({"package.xml"})))
    assert builds.runs == runs + 1


MANIFEST = '("share/" + package_name, ["package.xml"])'
"""A line of the solution's setup.py, to which lines can be added."""


def with_data_file(submission: Submission, pair: str) -> bytes:
    """Return setup.py of the submission with one more pair in data_files."""
    text = submission.files["setup.py"].decode()
    assert MANIFEST in text
    return text.replace(MANIFEST, f"{MANIFEST}, {pair}").encode()


@pytest.mark.parametrize(
    ("folder", "file"),
    [
        ("lib/my_robot_controller", NODE),
        (f"{SITE}/my_robot_controller", "config/draw_circle.py"),
        (f"{SITE}/my_robot_controller", NODE),
    ],
    ids=["a module that is a data file", "a data file in place of a module", "a module in its own place"],
)
def test_what_colcon_installs_does_not_depend_on_other_submissions(
    solution: Submission, folder: str, file: str
) -> None:
    setup_py = with_data_file(solution, f'("{folder}", ["{file}"])')
    package = with_files(solution, {"setup.py": setup_py, "config/draw_circle.py": b"print('data')\n"})
    shared = SharedBuilds()
    build(shared, with_node(package, "def main(): ...\n"))
    own = runner.build(package, find_ros(), in_cell=bubblewrap.usable(), tell=lambda _: None)
    assert members(build(shared, package).tree) == members(own.tree)


@pytest.mark.parametrize(
    "unusual",
    [
        {NODE: b"def main()\n"},
        {NODE: b'PATTERN = "\\d"\ndef main():\n    return 1 is 1\n'},
        {"setup.py": b"print(open('my_robot_controller/draw_circle.py').read())\n"},
        {"pyproject.toml": b""},
    ],
    ids=["a module that does not compile", "a module with a warning", "setup.py that does more", "pyproject.toml"],
)
def test_an_unusual_package_is_built_as_it_is(solution: Submission, unusual: dict[str, bytes]) -> None:
    colcon = Colcon()
    package = with_files(solution, unusual)
    build(SharedBuilds(colcon), package)
    assert colcon.packages == [package]


def test_nothing_is_shared_if_colcon_installs_other_files(solution: Submission, surprise: bytes) -> None:
    colcon = Colcon(surprise)
    builds = SharedBuilds(colcon)
    for each in (solution, with_node(solution, "")):
        assert build(builds, each).tree == surprise
    assert [package.files[NODE] for package in colcon.packages] == [b"", solution.files[NODE], b""]


def test_a_build_that_cannot_be_shared_is_not_stored(solution: Submission, surprise: bytes) -> None:
    stored: list[tuple[object, ...]] = []
    store: Any = SimpleNamespace(get=lambda _: None, put=lambda *entry: stored.append(entry))
    built = SharedBuilds(Colcon(surprise), store)(solution, find_ros(), in_cell=True, tell=lambda _: None)
    assert built.tree == surprise
    assert stored == []


def test_the_oldest_builds_are_forgotten(
    solution: Submission, surprise: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = with_files(solution, {TEST: b""})
    runs = []
    for most in (2, 1):
        monkeypatch.setattr("grader.colcon.shared_builds.MOST_BUILDS", most)
        builds = SharedBuilds(Colcon(surprise))
        for each in (solution, other, solution):
            build(builds, each)
        runs.append(builds.runs)
    assert runs == [5, 6]
