"""Hints for packages that are in a workspace, but not sourced."""

from __future__ import annotations

from argparse import Namespace
from typing import TYPE_CHECKING

import pytest

from grader.ros.failure import Ros2Error
from grader.ros2 import run, unsourced
from grader.ros2.pkg import executables, manifest, prefix
from grader.ros2.unsourced import meant, where_it_is

if TYPE_CHECKING:
    from pathlib import Path
    from types import ModuleType

BUILD = "not built. Type: cd ~/ros2_ws && colcon build && source install/setup.bash"


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Create a workspace with one package, and work in another folder."""
    package = tmp_path / "ros2_ws/src/my_robot_controller"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>my_robot_controller</name></package>")
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.chdir(tmp_path / "elsewhere")


def test_a_package_that_is_not_built() -> None:
    assert where_it_is("my_robot_controller") == f"The package is in ~/ros2_ws/src/my_robot_controller, but {BUILD}"
    assert where_it_is("my_robot_controler") == ""


def test_the_package_that_was_meant_is_in_the_workspace() -> None:
    hint = meant("my_robot_controler", ["rqt_console", "turtlesim"])
    assert hint.startswith("Did you mean 'my_robot_controller'? The package is in ~/ros2_ws/src/my_robot_controller")
    assert hint.endswith(BUILD)


def test_an_installed_package_with_a_nearer_name_was_meant() -> None:
    assert meant("turtlesm", ["rqt_console", "turtlesim"]) == ""
    assert meant("camera", ["rqt_console", "turtlesim"]) == ""


@pytest.mark.parametrize("verb", [run, executables, manifest, prefix])
def test_each_verb_about_a_package_says_that_it_is_not_built(
    verb: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    index = tmp_path / "ros/share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    (index / "rqt_console").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "ros"))
    args = Namespace(package_name="my_robot_controller", executable_name="draw_circle", prefix=None, argv=[])
    with pytest.raises(Ros2Error, match=r"not found\nThe package is in .*, but not built") as error:
        verb.run(args)
    assert "rqt_console" not in str(error.value)


def test_no_more_folders_are_searched_than_the_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(9):
        (tmp_path / f"ros2_ws/src/{number}").mkdir()
    (tmp_path / "ros2_ws/src/z").mkdir()
    (tmp_path / "ros2_ws/src/z/package.xml").write_text("<package><name>last</name></package>")
    assert where_it_is("last") != ""
    monkeypatch.setattr(unsourced, "_MOST", 9)
    assert where_it_is("last") == ""
