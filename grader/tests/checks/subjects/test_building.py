"""The checks of the build: colcon builds the package and installs its Python files."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Status
from grader.tests.checks.changed import BARE, INIT, LINKED, NOTHING, of, setup_py, xml
from grader.tests.checks.made import BUILD, SETUP_PY
from grader.tests.checks.told import told

if TYPE_CHECKING:
    from grader.colcon.build import Build
    from grader.tests.checks.changed import Files


SETUP_TRACEBACK = """\
--- stderr: my_robot_controller
Traceback (most recent call last):
  File "<string>", line 1, in <module>
  File "/ws/src/my_robot_controller/setup.py", line 5, in <module>
    raise RuntimeError("no")
RuntimeError: no
---
Failed   <<< my_robot_controller [0.61s, exited with code 1]
"""
READ_BY_COLCON = """\
Traceback (most recent call last):
  File "<string>", line 1, in <module>
  File "/env/setuptools/_distutils/core.py", line 268, in run_setup
    exec(code, g)
  File "<string>", line 7, in <module>
FileNotFoundError: [Errno 2] No such file or directory: 'README.md'
[0.5s] ERROR:colcon:Exception in job execution
Traceback (most recent call last):
  File "/env/colcon_core/executor/sequential.py", line 50, in execute
    loop.run_until_complete(future)
subprocess.CalledProcessError: Command '['python3', '-c', 'x']' returned non-zero exit status 1.
"""
UNREAD = """\
Traceback (most recent call last):
  File "/env/colcon_python_setup_py/python_setup_py.py", line 301, in _get_setup_information
    return ast.literal_eval(output)
  File "<unknown>", line 0
SyntaxError: invalid syntax
"""
NO_MARKER = "error: can't copy 'resource/my_robot_controller': doesn't exist or not a regular file\n"


@pytest.mark.parametrize(
    ("files", "build", "diagnosis", "where"),
    [
        ({"setup.py": None}, NOTHING, "setup-py-missing", "package.xml"),
        ({"COLCON_IGNORE": ""}, NOTHING, "colcon-ignore", "COLCON_IGNORE"),
        ({"AMENT_IGNORE": ""}, NOTHING, "colcon-ignore", "AMENT_IGNORE"),
        ({"setup.py": "setup(\n"}, replace(NOTHING, exit_code=1), "setup-py-syntax", "setup.py:1"),
        ({}, replace(NOTHING, exit_code=1, log=SETUP_TRACEBACK), "setup-py-raises", "setup.py:5"),
        ({"setup.cfg": "x\n"}, replace(NOTHING, exit_code=1, log=SETUP_TRACEBACK), "setup-cfg", "setup.cfg:1"),
        ({}, replace(NOTHING, exit_code=1, log=READ_BY_COLCON), "setup-py-raises", "setup.py:7"),
        ({}, replace(NOTHING, exit_code=1, log=UNREAD), "setup-py-output", "setup.py:5"),
        ({}, replace(NOTHING, exit_code=1, log=NO_MARKER), "data-file-missing", "setup.py:9"),
        ({}, replace(NOTHING, exit_code=1, log="error: no such option"), "build-failed", "setup.py:5"),
        ({}, replace(NOTHING, exit_code=-9, timed_out=True, seconds=60.0), "build-timeout", "setup.py:5"),
        ({}, replace(NOTHING, exit_code=1, out_of="disk"), "build-limit", "setup.py"),
        (setup_py(":main", ""), replace(NOTHING, exit_code=1), "entry-point-no-function", "setup.py:14"),
        ({INIT: None}, BARE, "missing-init", "setup.py:5"),
        ({INIT: None}, LINKED, "missing-init", "setup.py:5"),
        ({}, BARE, "nothing-installed", "setup.py:7"),
        ({}, replace(NOTHING, installed=()), "nothing-installed", "setup.py:7"),
    ],
)
def test_each_fault_of_the_build_has_its_diagnosis_and_place(
    files: Files, build: Build, diagnosis: str, where: str
) -> None:
    found = of("build", files, build)
    assert (found.status, found.diagnosis, str(found.where)) == (Status.FAILED, diagnosis, where)


@pytest.mark.parametrize(
    ("files", "cause"),
    [
        ({}, "data_files in setup.py lists a file that does not exist in the package."),
        ({"launch/a.py": ""}, "data_files in setup.py lists launch, which is a folder. List its files instead."),
    ],
)
def test_a_folder_in_data_files_is_told_from_a_missing_file(files: Files, cause: str) -> None:
    log = "error: can't copy 'launch': doesn't exist or not a regular file\n"
    found = of("build", files, replace(NOTHING, exit_code=1, log=log))
    assert (found.diagnosis, found.cause) == ("data-file-missing", cause)


@pytest.mark.parametrize(
    ("log", "told"),
    [("error: package directory 'src/x' does not exist\n", True), ("error: package directory 'src/x' is bad\n", False)],
)
def test_a_folder_of_packages_that_does_not_exist_is_told(log: str, *, told: bool) -> None:
    found = of("build", build=replace(NOTHING, exit_code=1, log=log))
    words = "packages or package_dir in setup.py names the folder src/x, which does not exist."
    assert (words in found.cause, found.diagnosis) == (told, "build-failed")


def test_the_last_words_of_a_failed_build_are_shown() -> None:
    found = of("build", build=replace(NOTHING, exit_code=1, log="warning: x\nerror: no such option\nfailed\n"))
    assert found.observed == "`colcon build` failed: error: no such option."


OTHER_TYPE = (
    "The build type in package.xml determines how colcon builds the package. This build type is not ament_python."
)


@pytest.mark.parametrize(
    ("files", "cause"),
    [
        ({}, ""),
        (xml("ament_python", "ament_cmake"), OTHER_TYPE),
        ({"package.xml": None}, ""),
        ({"package.xml": "<package>"}, ""),
    ],
)
def test_colcon_may_take_the_package_for_one_of_another_kind(files: Files, cause: str) -> None:
    failed = of("build", files, replace(NOTHING, exit_code=1))
    assert (failed.diagnosis, failed.cause, failed.observed) == (
        "build-failed",
        cause,
        "`colcon build` failed (exit code 1).",
    )
    finished = of("build", files, replace(NOTHING, package=None))
    assert (finished.diagnosis, finished.observed) == (
        "nothing-installed",
        "`colcon build` finished but installed nothing.",
    )
    nothing = of("build", files, replace(NOTHING, installed=()))
    assert nothing.cause == (cause or "The packages argument of setup() lists the folders to install.")
    for found in (failed, nothing):
        assert str(found.where).partition(":")[0] == ("package.xml" if cause else "setup.py")


def test_a_build_without_a_setup_py_is_shown_at_package_xml_if_there_is_one() -> None:
    assert of("build", {"setup.py": None, "package.xml": None}).where is None


@pytest.mark.parametrize(
    ("files", "build", "diagnosis", "cause"),
    [
        ({INIT: None}, BARE, "missing-init", "find_packages in setup.py finds only folders with an __init__.py."),
        ({INIT: None, **setup_py("find_packages(", "list_of(")}, BARE, "missing-init", ""),
        ({INIT: None, **setup_py("find_packages(", "list_of(")}, LINKED, None, ""),
        ({INIT: None, "other/__init__.py": "", "other/x.py": ""}, BARE, "nothing-installed", "The packages argument"),
        (
            {INIT: None, "test/x.py": ""},
            BARE,
            "missing-init",
            "find_packages in setup.py finds only folders with an __init__.py.",
        ),
        ({}, LINKED, None, ""),
        ({"deep/down/x.py": ""}, BUILD, None, ""),
    ],
)
def test_folders_that_are_no_packages_explain_that_nothing_was_installed(
    files: Files, build: Build, diagnosis: str | None, cause: str
) -> None:
    found = of("build", files, build)
    assert found.diagnosis == diagnosis
    assert found.cause.startswith(cause)


EMPTY = replace(NOTHING, installed=())
BROKEN = replace(NOTHING, exit_code=1, log="error: no such option")
SLOW = replace(NOTHING, exit_code=-9, timed_out=True, seconds=60.0)
LIMITED = replace(NOTHING, exit_code=1, out_of="memory")
NO_MARKERS = replace(BUILD, installed=tuple(path for path in BUILD.installed if "resource_index" not in path))


@pytest.mark.parametrize(
    ("words", "check", "true", "near"),
    [
        ("`colcon build` built and installed the package.", "build", ({}, BUILD), ({}, BARE)),
        (
            "installed none of the Python files: the folder my_robot_controller has no __init__.py.",
            "build",
            ({INIT: None}, BARE),
            ({}, BARE),
        ),
        (
            "Each folder with Python files has a file __init__.py, which can be empty.",
            "build",
            ({INIT: None}, BARE),
            ({}, BARE),
        ),
        (
            "colcon could not read the arguments of setup() in setup.py.",
            "build",
            ({}, replace(NOTHING, exit_code=1, log=UNREAD)),
            ({}, BROKEN),
        ),
        (
            "setup.py should only call setup(). setup.py must not print anything or exit.",
            "build",
            ({}, replace(NOTHING, exit_code=1, log=UNREAD)),
            ({}, BROKEN),
        ),
        ("`colcon build` used all the memory that a package may use.", "build", ({}, LIMITED), ({}, BROKEN)),
        ("setup.py should only call setup().", "build", ({}, LIMITED), ({}, BROKEN)),
        (
            "colcon builds an ament_python package by running its setup.py.",
            "build",
            ({"setup.py": None}, EMPTY),
            ({}, EMPTY),
        ),
        (
            "The package has a CMakeLists.txt, which colcon uses to build packages in C++.",
            "build",
            ({"setup.py": None, "CMakeLists.txt": "ament_package()\n"}, EMPTY),
            ({"setup.py": None, "src/CMakeLists.txt": ""}, EMPTY),
        ),
        ("`colcon build` was still running after 60 s.", "build", ({}, SLOW), ({}, BROKEN)),
        ("setup.py must not sleep, ask for input or loop.", "build", ({}, SLOW), ({}, LIMITED)),
        ("ROS 2 finds the installed package.", "installed", ({}, BUILD), ({}, NO_MARKERS)),
        (
            "`ros2 run` and other tools use these files to find a package.",
            "installed",
            ({}, NO_MARKERS),
            ({"package.xml": "<package>"}, NO_MARKERS),
        ),
        (
            "colcon cannot read package.xml, so it built a plain Python package.",
            "installed",
            ({"package.xml": "<package>"}, NO_MARKERS),
            ({}, NO_MARKERS),
        ),
    ],
)
def test_a_sentence_about_the_build_is_true(
    words: str, check: str, true: tuple[Files, Build], near: tuple[Files, Build]
) -> None:
    assert words in told(of(check, *true))
    assert words not in told(of(check, *near))


PLAIN: Files = {
    "setup.py": SETUP_PY.replace("    packages", '    version="0.1.0",\n    packages'),
    "setup.cfg": (
        "[develop]\nscript_dir=$base/lib/my_robot_controller\n"
        "[install]\ninstall_scripts=$base/lib/my_robot_controller\n"
    ),
}
MISSPELT: Files = {**PLAIN, "setup.py": str(PLAIN["setup.py"]).replace(":main", ".main")}
CONFIGURED: Files = {**PLAIN, "setup.cfg": f"{PLAIN['setup.cfg']!s}[metadata]\nversion = attr: slow.VERSION\n"}
SLEEPS: Files = {**PLAIN, "setup.py": f"import time\ntime.sleep(99)\n{PLAIN['setup.py']!s}"}


@pytest.mark.parametrize(
    ("files", "status"),
    [
        (PLAIN, Status.ERROR),
        (MISSPELT, Status.ERROR),
        (SLEEPS, Status.FAILED),
        (CONFIGURED, Status.FAILED),
    ],
)
def test_a_slow_build_of_a_usual_setup_py_is_not_the_students_fault(files: Files, status: Status) -> None:
    found = of("build", files, SLOW)
    assert found.status is status
    words = "although setup.py only calls setup(). Try again when the machine is less busy."
    assert (words in found.observed) == (status is Status.ERROR)
