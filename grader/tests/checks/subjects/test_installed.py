"""The check of the install folder: it contains the files by which ROS 2 finds the package."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Status
from grader.tests.checks.changed import of, setup_py, xml
from grader.tests.checks.made import BUILD

if TYPE_CHECKING:
    from grader.tests.checks.changed import Files


def test_what_ros_2_finds_a_package_by_must_be_installed() -> None:
    no_marker = tuple(path for path in BUILD.installed if "resource_index" not in path)
    found = of("installed", build=replace(BUILD, installed=no_marker))
    assert (found.diagnosis, found.observed) == (
        "resource-marker",
        "Not installed: the marker file resource/my_robot_controller.",
    )
    assert str(found.where) == "setup.py:5"
    no_xml = tuple(path for path in BUILD.installed if "package.xml" not in path)
    found = of("installed", build=replace(BUILD, installed=no_xml))
    assert (found.diagnosis, str(found.where)) == ("package-xml-not-installed", "setup.py:5")
    nothing = of("installed", {"setup.py": None}, replace(BUILD, installed=()))
    assert (nothing.diagnosis, str(nothing.where)) == ("resource-marker", "setup.py")
    assert nothing.observed == "Not installed: the marker file resource/my_robot_controller and package.xml."


@pytest.mark.parametrize(
    ("files", "package", "name"),
    [
        ({}, "my_robot", "my_robot"),
        (xml("<name>my_robot_controller", "<name>by_package_xml"), None, "by_package_xml"),
        ({"package.xml": None, **setup_py('"my_robot_controller"', '"by_setup_py"')}, None, "by_setup_py"),
        ({"package.xml": None, "setup.py": None}, None, "my_robot_controller"),
        ({"package.xml": None, "setup.py": "setup()\n"}, None, "my_robot_controller"),
    ],
)
def test_the_package_is_looked_for_by_the_name_that_colcon_knows(files: Files, package: str | None, name: str) -> None:
    found = of("installed", files, replace(BUILD, package=package, installed=()))
    assert found.observed == f"Not installed: the marker file resource/{name} and package.xml."
    both = (f"share/ament_index/resource_index/packages/{name}", f"share/{name}/package.xml")
    assert of("installed", files, replace(BUILD, package=package, installed=both)).status is Status.PASSED
