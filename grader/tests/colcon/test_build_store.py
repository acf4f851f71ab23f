"""The next command finds a stored build, unless something that affects a build has changed or the file is damaged."""

from __future__ import annotations

import os
import time
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.colcon import build_store as store_module
from grader.colcon import runner
from grader.colcon.build import Build
from grader.colcon.build_store import MOST_BUILDS, BuildStore, build_store, key_of
from grader.colcon.runner import Built
from grader.colcon.shared_builds import SharedBuilds
from grader.ros.installation import find_ros
from grader.sandbox import bubblewrap
from grader.submission.package import digest, open_submission
from grader.tests.case import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from grader.submission.package import Submission

NODE = "my_robot_controller/draw_circle.py"
BUILT = Built(
    Build(0, "log\n", "my_robot_controller", installed=("a", "b"), entry_points={"node": "a:b"}, seconds=1.5), b"\x00\n"
)


@pytest.fixture(scope="module")
def solution() -> Submission:
    return open_submission(ROOT / "solutions/03-circle-publisher")


def test_a_stored_build_is_the_same(tmp_path: Path) -> None:
    store = BuildStore(tmp_path / "builds")
    assert store.get("a") is None
    store.put("a", BUILT)
    assert store.get("a") == BUILT
    assert store.get("b") is None


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: data[:0],
        lambda data: data[:-1],
        lambda data: data.replace(b"log", b"lag"),
        lambda data: b"x" + data,
    ],
    ids=["empty", "cut off", "changed", "longer"],
)
def test_a_damaged_file_is_ignored(tmp_path: Path, damage: Callable[[bytes], bytes]) -> None:
    store = BuildStore(tmp_path)
    store.put("a", BUILT)
    (tmp_path / "a").write_bytes(damage((tmp_path / "a").read_bytes()))
    assert store.get("a") is None


def test_the_oldest_builds_are_removed(tmp_path: Path) -> None:
    store = BuildStore(tmp_path)
    for number in range(MOST_BUILDS + 2):
        store.put(str(number), BUILT)
        os.utime(tmp_path / str(number), (number, number))
    store.put("new", BUILT)
    assert {path.name for path in tmp_path.iterdir()} == {"new", *map(str, range(3, MOST_BUILDS + 2))}


def test_builds_from_before_the_clock_was_set_back_are_removed_first(tmp_path: Path) -> None:
    store = BuildStore(tmp_path)
    tomorrow = time.time() + 86400
    for number in range(MOST_BUILDS):
        store.put(str(number), BUILT)
        os.utime(tmp_path / str(number), (tomorrow + number, tomorrow + number))
    store.put("new", BUILT)
    store.put("newer", BUILT)
    assert {path.name for path in tmp_path.iterdir()} == {"new", "newer", *map(str, range(2, MOST_BUILDS))}


def test_without_a_writable_folder_nothing_is_stored(tmp_path: Path) -> None:
    (tmp_path / "builds").write_text("a file, not a folder")
    store = BuildStore(tmp_path / "builds")
    store.put("a", BUILT)
    assert store.get("a") is None


def test_the_key_changes_with_what_affects_a_build(solution: Submission) -> None:
    ros = find_ros()
    key = key_of(solution, ros)
    assert key_of(solution, ros) == key
    assert key_of(replace(solution, digest=digest({})), ros) != key
    assert key_of(replace(solution, executable=frozenset({"setup.py"})), ros) != key
    assert key_of(solution, replace(ros, version="another")) != key


def test_the_key_changes_with_a_file_that_the_build_script_imports(
    solution: Submission, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    key = key_of(solution, find_ros())
    changed = tmp_path / "quick_exit.py"
    changed.write_text("changed = True\n")
    monkeypatch.setattr(runner, "IMPORTED", (changed,))
    store_module._tools.cache_clear()
    try:
        assert key_of(solution, find_ros()) != key
    finally:
        store_module._tools.cache_clear()


def test_the_next_command_does_not_run_colcon(
    solution: Submission, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not bubblewrap.usable():
        pytest.skip("builds are only stored if they ran in a cell")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    changed = replace(solution, files={**solution.files, NODE: b"def main():\n    print(1)\n"})
    runs, trees = [], []
    for package in (solution, changed):
        builds = SharedBuilds(store=build_store())
        trees.append(builds(package, find_ros(), in_cell=True, tell=lambda _: None).tree)
        runs.append(builds.runs)
    assert runs == [1, 0]
    assert changed.files[NODE] in trees[1]
    assert solution.files[NODE] not in trees[1]
    with_xml = replace(solution, digest="other", files={**solution.files, "package.xml": b"<package/>"})
    builds = SharedBuilds(store=build_store())
    builds(with_xml, find_ros(), in_cell=True, tell=lambda _: None)
    assert builds.runs == 1
