"""The checks of the package: its files, package.xml, its name, the build, what was installed, the entry point."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.outcome import Status
from grader.tests.checks.made import (
    BUILD,
    NODE,
    NODE_FILE,
    PACKAGE_XML,
    SETUP_PY,
    evidence,
    finding,
    submission,
)

if TYPE_CHECKING:
    from grader.build import Build
    from grader.outcome import Finding

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


def xml(old: str = "", new: str = "") -> dict[str, str | bytes | None]:
    assert old in PACKAGE_XML
    return {"package.xml": PACKAGE_XML.replace(old, new)}


def setup_py(old: str, new: str) -> dict[str, str | bytes | None]:
    assert old in SETUP_PY
    return {"setup.py": SETUP_PY.replace(old, new)}


def of(check: str, files: dict[str, str | bytes | None] | None = None, build: Build = BUILD) -> Finding:
    return finding(check, evidence(package=submission(files), build=build))


@pytest.mark.parametrize(
    "check", ["files", "package-xml", "dependencies", "package-name", "build", "installed", "entry-point"]
)
@pytest.mark.parametrize("build", [BUILD, LINKED], ids=["copied", "linked"])
def test_a_good_package_passes(check: str, build: Build) -> None:
    found = of(check, build=build)
    assert (found.status, found.diagnosis) == (Status.PASSED, None), found.seen


@pytest.mark.parametrize(
    ("check", "files", "diagnosis", "where"),
    [
        ("package-xml", {"package.xml": None}, "package-xml-missing", "setup.py"),
        ("package-xml", xml("</package>"), "xml-malformed", "package.xml:15"),
        ("package-xml", xml("  <license>MIT</license>\n"), "package-xml-invalid", "package.xml:2"),
        ("package-xml", xml('format="3"', 'format="9"'), "package-xml-invalid", "package.xml:2"),
        ("package-xml", xml('format="3"', 'format="x"'), "package-xml-invalid", "package.xml:2"),
        ("package-xml", {"package.xml": b"\xff\xfe\x00"}, "xml-malformed", "package.xml:1"),
        ("package-xml", {"package.xml": b"<a>" * 100_000}, "package-xml-invalid", "package.xml"),
        ("package-xml", xml("    <build_type>ament_python</build_type>\n"), "build-type", "package.xml:11"),
        ("package-xml", xml("ament_python", "ament_cmake"), "build-type", "package.xml:12"),
        ("dependencies", xml("  <depend>geometry_msgs</depend>\n"), "missing-depend", "package.xml:8"),
        (
            "dependencies",
            xml("depend>rclpy</depend", "build_depend>rclpy</build_depend"),
            "depend-kind",
            "package.xml:8",
        ),
        ("package-name", xml("my_robot_controller", "my_robot"), "package-name", "package.xml:3"),
        ("package-name", setup_py('"my_robot_controller"', '"my-robot-controller"'), "package-name", "setup.py:3"),
        ("package-name", {INIT: None, NODE_FILE: None, "my_robot/x.py": ""}, "package-folder", "setup.py"),
    ],
)
def test_each_fault_of_the_files(check: str, files: dict[str, str | bytes | None], diagnosis: str, where: str) -> None:
    found = of(check, files)
    assert (found.status, found.diagnosis, str(found.where)) == (Status.FAILED, diagnosis, where)


def test_format_2_is_valid_and_a_byte_order_mark_does_no_harm() -> None:
    assert of("package-xml", xml('format="3"', 'format="2"')).status is Status.PASSED
    assert of("package-xml", {"package.xml": b"\xef\xbb\xbf" + PACKAGE_XML.encode()}).status is Status.PASSED


def test_a_misspelt_dependency_is_shown() -> None:
    found = of("dependencies", xml("geometry_msgs", "geometry_msg"))
    assert found.seen == "package.xml does not declare geometry_msgs."
    assert found.cause == 'It has "geometry_msg": is that a typing error?'


@pytest.mark.parametrize(
    ("more", "seen"),
    [
        ((), "Left out: data: a link that leaves the package."),
        (("x",), "Left out: data: a link that leaves the package (and 1 more)."),
        (("x", "y"), "Left out: data: a link that leaves the package (and 2 more)."),
    ],
)
def test_what_was_left_out_of_the_submission_is_told(more: tuple[str, ...], seen: str) -> None:
    given = evidence(package=submission(rejected=("data: a link that leaves the package.", *more)))
    found = finding("files", given)
    assert (found.diagnosis, found.seen) == ("rejected-file", seen)


@pytest.mark.parametrize(
    ("files", "diagnosis", "where", "cause"),
    [
        (
            {"package.xml": f"{PACKAGE_XML}<more/>"},
            "xml-malformed",
            "package.xml:15",
            "After the last tag, </package>, nothing may follow.",
        ),
        (
            xml("</depend>\n  <depend>turtle", "</depends>\n  <depend>turtle"),
            "xml-malformed",
            "package.xml:9",
            "<depend> in line 9 is not closed by a tag of the same name with a slash.",
        ),
        (
            xml("MIT", "M & T"),
            "xml-malformed",
            "package.xml:7",
            "Each <tag> ends with a </tag> of the same name, the inner one before the outer one.",
        ),
        (
            xml("<depend>rclpy</depend>", "<run_depend>rclpy</run_depend>"),
            "package-xml-old-tag",
            "package.xml:8",
            "<run_depend> is of format 1, that of ROS 1; format 3 has <exec_depend>, and <depend> for all.",
        ),
    ],
)
def test_a_package_xml_that_cannot_be_read_is_explained(
    files: dict[str, str | bytes | None], diagnosis: str, where: str, cause: str
) -> None:
    found = of("package-xml", files)
    assert (found.diagnosis, str(found.where), found.cause) == (diagnosis, where, cause)


@pytest.mark.parametrize("files", [{"package.xml": None}, {"package.xml": "<package>"}])
def test_without_a_package_xml_nothing_is_declared(files: dict[str, str | bytes | None]) -> None:
    found = of("dependencies", files)
    assert (found.diagnosis, str(found.where)) == ("package-xml-invalid", "package.xml")


@pytest.mark.parametrize(
    ("files", "cause"),
    [
        (xml("my_robot_controller", "my-robot"), "A ROS 2 package's name has underscores, not dashes."),
        (xml("my_robot_controller", "my_robot"), ""),
        (setup_py('"my_robot_controller"', '"my-robot"'), "A ROS 2 package's name has underscores, not dashes."),
        (
            {INIT: None, NODE_FILE: None, "my_robot_control/x.py": "", "my_robot_controllers/a/b.py": "", "x.py": ""},
            "There is a folder my_robot_control.",
        ),
        ({INIT: None, NODE_FILE: None, "quaff/x.py": ""}, ""),
    ],
)
def test_another_name_is_explained(files: dict[str, str | bytes | None], cause: str) -> None:
    found = of("package-name", files)
    assert (found.status, found.cause) == (Status.FAILED, cause)


def test_a_setup_py_that_says_no_name_contradicts_nobody() -> None:
    for text in (None, "setup()\n", "setup(\n"):
        assert of("package-name", {"setup.py": text}).status is Status.PASSED


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
        ({"setup.py": "setup(\n"}, replace(NOTHING, exit_code=1), "setup-py-syntax", "setup.py:1"),
        ({}, replace(NOTHING, exit_code=1, log=SETUP_TRACEBACK), "setup-py-raises", "setup.py:5"),
        ({}, replace(NOTHING, exit_code=1, log=READ_BY_COLCON), "setup-py-raises", "setup.py:7"),
        ({}, replace(NOTHING, exit_code=1, log=UNREAD), "setup-py-output", "setup.py:5"),
        ({}, replace(NOTHING, exit_code=1, log=NO_MARKER), "data-file-missing", "setup.py:5"),
        ({}, replace(NOTHING, exit_code=1, log="error: no such option"), "build-failed", "setup.py:5"),
        ({}, replace(NOTHING, exit_code=-9, timed_out=True, seconds=60.0), "build-timeout", "setup.py:5"),
        ({}, replace(NOTHING, exit_code=1, out_of="disk"), "build-limit", "setup.py"),
        (setup_py(":main", ""), replace(NOTHING, exit_code=1), "entry-point-no-function", "setup.py:14"),
        ({INIT: None}, BARE, "missing-init", "setup.py:5"),
        ({INIT: None}, LINKED, "missing-init", "setup.py:5"),
        ({}, BARE, "nothing-installed", "setup.py:5"),
        ({}, replace(NOTHING, installed=()), "nothing-installed", "setup.py:5"),
    ],
)
def test_each_fault_of_the_build(
    files: dict[str, str | bytes | None], build: Build, diagnosis: str, where: str
) -> None:
    found = of("build", files, build)
    assert (found.status, found.diagnosis, str(found.where)) == (Status.FAILED, diagnosis, where)


def test_the_last_words_of_a_failed_build_are_shown() -> None:
    found = of("build", build=replace(NOTHING, exit_code=1, log="warning: x\nerror: no such option\nfailed\n"))
    assert found.seen == "`colcon build` failed: error: no such option."


def test_what_ros_2_finds_a_package_by_must_be_installed() -> None:
    no_marker = tuple(path for path in BUILD.installed if "resource_index" not in path)
    found = of("installed", build=replace(BUILD, installed=no_marker))
    assert (found.diagnosis, found.seen) == (
        "resource-marker",
        "Not installed: the marker resource/my_robot_controller.",
    )
    assert str(found.where) == "setup.py:5"
    no_xml = tuple(path for path in BUILD.installed if "package.xml" not in path)
    found = of("installed", build=replace(BUILD, installed=no_xml))
    assert (found.diagnosis, str(found.where)) == ("package-xml-not-installed", "setup.py:5")
    nothing = of("installed", {"setup.py": None}, replace(BUILD, installed=()))
    assert (nothing.diagnosis, str(nothing.where)) == ("resource-marker", "setup.py")
    assert nothing.seen == "Not installed: the marker resource/my_robot_controller and package.xml."


@pytest.mark.parametrize(
    ("files", "package", "name"),
    [
        ({}, "my_robot", "my_robot"),
        (xml("<name>my_robot_controller", "<name>by_package_xml"), None, "by_package_xml"),
        ({"package.xml": None, **setup_py('"my_robot_controller"', '"by_setup_py"')}, None, "by_setup_py"),
        ({"package.xml": "<package>", **setup_py('"my_robot_controller"', '"by_setup_py"')}, None, "by_setup_py"),
        ({"package.xml": None, "setup.py": None}, None, "my_robot_controller"),
        ({"package.xml": None, "setup.py": "setup()\n"}, None, "my_robot_controller"),
    ],
)
def test_the_package_is_looked_for_by_the_name_that_colcon_knows(
    files: dict[str, str | bytes | None], package: str | None, name: str
) -> None:
    found = of("installed", files, replace(BUILD, package=package, installed=()))
    assert found.seen == f"Not installed: the marker resource/{name} and package.xml."
    both = (f"share/ament_index/resource_index/packages/{name}", f"share/{name}/package.xml")
    assert of("installed", files, replace(BUILD, package=package, installed=both)).status is Status.PASSED


OTHER_TYPE = "colcon goes by package.xml, which is not that of an ament_python package."


@pytest.mark.parametrize(
    ("files", "cause"),
    [
        ({}, ""),
        (xml("ament_python", "ament_cmake"), OTHER_TYPE),
        ({"package.xml": None}, ""),
        ({"package.xml": "<package>"}, ""),
    ],
)
def test_colcon_may_take_the_package_for_one_of_another_kind(files: dict[str, str | bytes | None], cause: str) -> None:
    failed = of("build", files, replace(NOTHING, exit_code=1))
    assert (failed.diagnosis, failed.cause, failed.seen) == (
        "build-failed",
        cause,
        "`colcon build` failed (exit code 1).",
    )
    nothing = of("build", files, replace(NOTHING, installed=()))
    assert nothing.cause == (cause or "The argument packages of setup() says which folders to install.")


def test_a_build_without_a_setup_py_is_shown_at_package_xml_if_there_is_one() -> None:
    assert of("build", {"setup.py": None, "package.xml": None}).where is None


@pytest.mark.parametrize(
    ("files", "build", "diagnosis", "cause"),
    [
        ({INIT: None}, BARE, "missing-init", "find_packages in setup.py finds only such folders."),
        ({INIT: None, **setup_py("find_packages(", "list_of(")}, BARE, "missing-init", ""),
        ({INIT: None, **setup_py("find_packages(", "list_of(")}, LINKED, None, ""),
        ({INIT: None, "other/__init__.py": "", "other/x.py": ""}, BARE, "nothing-installed", "The argument packages"),
        ({INIT: None, "test/x.py": ""}, BARE, "missing-init", "find_packages in setup.py finds only such folders."),
        ({}, LINKED, None, ""),
        ({"deep/down/x.py": ""}, BUILD, None, ""),
    ],
)
def test_folders_that_are_no_packages_explain_that_nothing_was_installed(
    files: dict[str, str | bytes | None], build: Build, diagnosis: str | None, cause: str
) -> None:
    found = of("build", files, build)
    assert found.diagnosis == diagnosis
    assert found.cause.startswith(cause)


@pytest.mark.parametrize(
    ("text", "diagnosis"),
    [
        ("draw_circle", "entry-point-no-function"),
        ("draw_circle = a b:main", "entry-point-format"),
        ("draw_circle = a/b.py:main", "entry-point-slash"),
        ("a = b:c d = e:f", "entry-point-comma"),
    ],
)
def test_a_text_that_is_no_entry_point_is_explained_by_its_signs(text: str, diagnosis: str) -> None:
    found = of("build", setup_py(POINT, text), replace(NOTHING, exit_code=1))
    assert (found.diagnosis, str(found.where)) == (diagnosis, "setup.py:14")


def test_a_node_under_another_file_name_that_no_entry_point_leads_to_is_shown() -> None:
    files = {NODE_FILE: None, "my_robot_controller/circle.py": NODE, **setup_py(f'            "{POINT}",\n', "")}
    found = of("entry-point", files, NOTHING)
    assert found.cause.startswith("my_robot_controller/circle.py is there, but setup.py does not name it")


def leads_to(target: str) -> Build:
    return replace(BUILD, entry_points={"draw_circle": target})


@pytest.mark.parametrize(
    ("files", "build", "diagnosis", "where"),
    [
        (setup_py(f'            "{POINT}",\n', ""), NOTHING, "entry-point-missing", "setup.py:5"),
        (setup_py("console_scripts", "console_script"), NOTHING, "entry-point-group", "setup.py:14"),
        (
            setup_py(f'"{POINT}",', f'"test_node = my_robot_controller.first:main"\n            "{POINT}",'),
            replace(NOTHING, entry_points={"test_node": "x"}),
            "entry-point-comma",
            "setup.py:14",
        ),
        (
            setup_py("draw_circle = ", "draw_cirle = "),
            replace(
                NOTHING,
                entry_points={"draw_cirle": "my_robot_controller.draw_circle:main"},
                executables=("draw_cirle",),
            ),
            "entry-point-name",
            "setup.py:14",
        ),
        ({"setup.cfg": None}, replace(BUILD, executables=()), "setup-cfg", "setup.py"),
        ({}, leads_to("my_robot_controller.drawcircle:main"), "entry-point-module", "setup.py:14"),
        ({}, leads_to("draw_circle:main"), "entry-point-module", "setup.py:14"),
        ({}, leads_to("my_robot_controller.draw_circle:man"), "entry-point-function", "setup.py:14"),
        ({NODE_FILE: NODE + "\nmain = 7\n"}, BUILD, "entry-point-not-callable", f"{NODE_FILE}:23"),
        ({NODE_FILE: NODE.replace("def send(self):", "def send(self)")}, BUILD, "colon-missing", f"{NODE_FILE}:12"),
        ({NODE_FILE: b"name = '\xe4'\n"}, BUILD, "not-utf8", NODE_FILE),
        ({NODE_FILE: NODE.encode() + b"\0"}, BUILD, "syntax-error", NODE_FILE),
        (
            {"my_robot_controller/more/node.py": NODE},
            leads_to("my_robot_controller.more.node:main"),
            "module-not-installed",
            "setup.py:14",
        ),
    ],
)
def test_each_fault_of_the_entry_point(
    files: dict[str, str | bytes | None], build: Build, diagnosis: str, where: str
) -> None:
    found = of("entry-point", files, build)
    assert (found.status, found.diagnosis) == (Status.FAILED, diagnosis), found.seen
    assert str(found.where).startswith(where)


def test_a_setup_cfg_that_is_there_is_a_place_to_look() -> None:
    nowhere = replace(BUILD, executables=())
    assert of("entry-point", {"setup.cfg": None}, nowhere).cause == "setup.cfg is missing."
    assert str(of("entry-point", {}, nowhere).where) == "setup.cfg"


@pytest.mark.parametrize(
    "text",
    [
        "from my_robot_controller.other import main\n",
        "from my_robot_controller.other import *\n",
        "try:\n    import rclpy\nexcept ImportError:\n    def main():\n        pass\n",
        "class main:\n    pass\n",
        "main = lambda: None\n",
        "main = 7\ndef main():\n    pass\n",
        "if True:\n    def main():\n        pass\n",
        "import other as main\n",
    ],
)
def test_anything_that_may_be_called_will_do(text: str) -> None:
    assert of("entry-point", {NODE_FILE: text}).status is Status.PASSED


def test_a_function_inside_of_the_class_is_not_found() -> None:
    found = of("entry-point", {NODE_FILE: "class A:\n    def main(self):\n        pass\n"})
    assert found.cause == "main is indented, and so belongs to the class above it: move it to the left edge."


@pytest.mark.parametrize("text", [b"x = " + b"(" * 5000, b"x = " + b"-" * 90_000 + b"1", b"a" * 500_000])
def test_a_file_that_is_too_much_to_parse_is_left_to_the_trial(text: bytes) -> None:
    assert of("entry-point", {NODE_FILE: text}).status in (Status.PASSED, Status.FAILED)
