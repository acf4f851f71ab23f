"""The reasons why the executable is not where `ros2 run` looks for it: the line install_scripts in setup.cfg."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.tests.checks.made import BUILD, evidence, finding, submission

Files = dict[str, str | bytes | None]

NO_LINE = "setup.cfg has no line that begins with install_scripts."
OTHER_FOLDER = "install_scripts must be $base/lib/ and the name of the package."
OTHER_SECTION = "install_scripts must be in the section [install]."


def setup_cfg(section: str, folder: str) -> Files:
    return {"setup.cfg": f"{section}\ninstall_scripts = $base/lib/{folder}\n"}


@pytest.mark.parametrize(
    ("files", "package", "where", "cause"),
    [
        ({"setup.cfg": None}, "my_robot_controller", "setup.py", "setup.cfg is missing."),
        ({}, "my_robot_controller", "setup.cfg", NO_LINE),
        ({}, None, "setup.cfg", NO_LINE),
        (setup_cfg("[install]", "robot"), "my_robot_controller", "setup.cfg:2", OTHER_FOLDER),
        (setup_cfg("[instal]", "my_robot_controller"), "my_robot_controller", "setup.cfg:2", OTHER_SECTION),
        ({}, "my_robot", "setup.cfg", "The folder name must be the package name in package.xml."),
    ],
)
def test_an_executable_in_another_folder_is_reported(files: Files, package: str | None, where: str, cause: str) -> None:
    build = replace(BUILD, executables=(), package=package)
    got = finding("entry-point", evidence(package=submission(files), build=build))
    assert (got.diagnosis, str(got.where), got.cause) == ("setup-cfg", where, cause)
    assert f"lib/{package or 'my_robot_controller'}." in got.observed
