"""Changed copies of the tutorial's package, and the results of building the copies."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from grader.tests.checks.made import BUILD, PACKAGE_XML, SETUP_PY, evidence, finding, submission

if TYPE_CHECKING:
    from grader.checks.outcome import Finding
    from grader.colcon.build import Build

Files = dict[str, str | bytes | None]

POINT = "draw_circle = my_robot_controller.draw_circle:main"
INIT = "my_robot_controller/__init__.py"
LINKED = replace(
    BUILD,
    installed=(
        "lib/my_robot_controller/draw_circle",
        "lib/python3.11/site-packages/my-robot-controller.egg-link",
        "share/ament_index/resource_index/packages/my_robot_controller",
        "share/my_robot_controller/package.xml",
    ),
)
BARE = replace(BUILD, installed=("lib/my_robot_controller/draw_circle", "share/my_robot_controller/package.xml"))
NOTHING = replace(BUILD, executables=(), entry_points={})


def xml(old: str = "", new: str = "") -> Files:
    assert old in PACKAGE_XML
    return {"package.xml": PACKAGE_XML.replace(old, new)}


def setup_py(old: str, new: str) -> Files:
    assert old in SETUP_PY
    return {"setup.py": SETUP_PY.replace(old, new)}


def of(check: str, files: Files | None = None, build: Build = BUILD) -> Finding:
    return finding(check, evidence(package=submission(files), build=build))
