"""The checks of package.xml, of the package's name and of its dependencies."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.kinds import KINDS
from grader.checks.outcome import Status
from grader.evidence.evidence import Evidence
from grader.submission.tree import read_folder
from grader.tests.case import ROOT
from grader.tests.checks.changed import INIT, LINKED, of, setup_py, xml
from grader.tests.checks.made import BUILD, NODE_FILE, PACKAGE_XML, submission
from grader.tests.checks.told import told

if TYPE_CHECKING:
    from grader.colcon.build import Build
    from grader.tests.checks.changed import Files


@pytest.mark.parametrize(
    "check", ["files", "package-xml", "dependencies", "package-name", "build", "installed", "entry-point"]
)
@pytest.mark.parametrize("build", [BUILD, LINKED], ids=["copied", "linked"])
def test_a_good_package_passes(check: str, build: Build) -> None:
    found = of(check, build=build)
    assert (found.status, found.diagnosis) == (Status.PASSED, None), found.observed


@pytest.mark.parametrize(
    ("check", "files", "diagnosis", "where"),
    [
        ("package-xml", {"package.xml": None}, "package-xml-missing", "setup.py"),
        ("package-xml", xml("</package>"), "xml-malformed", "package.xml:2"),
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
            xml("  <depend>rclpy</depend>", "  <depend>Twist</depend>\n  <depend>rclpy</depend>"),
            "depend-on-class",
            "package.xml:8",
        ),
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
def test_each_fault_of_the_files(check: str, files: Files, diagnosis: str, where: str) -> None:
    found = of(check, files)
    assert (found.status, found.diagnosis, str(found.where)) == (Status.FAILED, diagnosis, where)


def test_format_2_is_valid_and_a_byte_order_mark_does_no_harm() -> None:
    assert of("package-xml", xml('format="3"', 'format="2"')).status is Status.PASSED
    assert of("package-xml", {"package.xml": b"\xef\xbb\xbf" + PACKAGE_XML.encode()}).status is Status.PASSED


def test_a_misspelt_dependency_is_shown() -> None:
    found = of("dependencies", xml("geometry_msgs", "geometry_msg"))
    assert found.observed == "package.xml does not declare geometry_msgs."
    assert found.cause == 'The file declares "geometry_msg". Is that a typo?'


NODE_IMPORT = "from geometry_msgs.msg import Twist\n"


@pytest.mark.parametrize(
    ("line", "missing"),
    [
        ("from std_msgs.msg import String\n", "std_msgs"),
        ("import sensor_msgs.msg as messages\n", "sensor_msgs"),
        ("def later():\n    from std_srvs.srv import Empty\n", "std_srvs"),
        ("import numpy, math\n", None),
        ("from std_msgs.msg import Twist\n", None),
        ("from std_msgs.msg import Twist, String\n", "std_msgs"),
        ("from sensor_msgs.msg import Pose\n", "sensor_msgs"),
        ("from .helper_msgs import text\n", None),
        ("try:\n    from tf2_ros import Buffer\nexcept ImportError:\n    Buffer = None\n", None),
        ("if TYPE_CHECKING:\n    from std_msgs.msg import String\n", None),
    ],
)
def test_what_the_node_imports_must_be_declared(line: str, missing: str | None) -> None:
    source = submission().files[NODE_FILE].decode()
    at = source[: source.index(NODE_IMPORT)].count("\n") + 1
    found = of("dependencies", {NODE_FILE: source.replace(NODE_IMPORT, line + NODE_IMPORT)})
    if missing is None:
        assert found.status is Status.PASSED
        return
    assert (found.status, found.diagnosis) == (Status.FAILED, "missing-depend")
    assert found.observed == f"package.xml does not declare {missing}."
    assert found.cause.startswith(f"{NODE_FILE}:{at + line.count(chr(10)) - 1} imports ")


def test_the_imports_of_each_node_of_an_exercise_must_be_declared() -> None:
    step = find_exercise("07-challenges")
    files = read_folder(ROOT / "solutions/07-challenges/my_robot_controller").files
    last = f"my_robot_controller/{step.trials[-1].executable}.py"
    files = {**files, last: b"from std_msgs.msg import String\n" + files[last]}
    given = Evidence(step, replace(submission(), files=files))
    spec = next(each for each in step.checks if each.id == "dependencies")
    found = KINDS["dependencies"].judge(given, spec.params)
    assert found.observed == "package.xml does not declare std_msgs."
    assert found.cause.startswith(f"{last}:1 imports ")


def test_another_node_of_the_package_may_import_what_it_likes() -> None:
    assert of("dependencies", {"my_robot_controller/other.py": "import std_msgs.msg\n"}).status is Status.PASSED


@pytest.mark.parametrize("files", [{"package.xml": None}, {"package.xml": "<package>"}])
def test_without_a_package_xml_nothing_is_declared(files: Files) -> None:
    found = of("dependencies", files)
    assert (found.diagnosis, str(found.where)) == ("package-xml-invalid", "package.xml")


@pytest.mark.parametrize(
    ("files", "cause"),
    [
        (xml("my_robot_controller", "my-robot"), "ROS 2 package names use underscores, not dashes."),
        (xml("my_robot_controller", "my_robot"), ""),
        (setup_py('"my_robot_controller"', '"my-robot"'), "ROS 2 package names use underscores, not dashes."),
        (
            {INIT: None, NODE_FILE: None, "my_robot_control/x.py": "", "my_robot_controllers/a/b.py": "", "x.py": ""},
            "A similar folder exists: my_robot_control.",
        ),
        ({INIT: None, NODE_FILE: None, "quaff/x.py": ""}, ""),
    ],
)
def test_another_name_is_explained(files: Files, cause: str) -> None:
    found = of("package-name", files)
    assert (found.status, found.cause) == (Status.FAILED, cause)


def test_a_setup_py_without_a_readable_name_passes() -> None:
    for text in (None, "setup()\n", "setup(\n"):
        assert of("package-name", {"setup.py": text}).status is Status.PASSED


MISSING = xml("  <depend>geometry_msgs</depend>\n")
COMMENT = xml("  <depend>geometry_msgs</depend>\n", "  <!-- <depend>geometry_msgs</depend> -->\n")
PROSE = xml("  <depend>geometry_msgs</depend>\n", "  <!-- The node sends geometry_msgs. -->\n")
ONLY_TESTS = xml("depend>rclpy</depend", "test_depend>rclpy</test_depend")
CMAKE = xml("ament_python", "ament_cmake")
MODULE = xml("<depend>geometry_msgs</depend>", "<depend>geometry_msgs.msg</depend>")
EXPORTED = {
    "package.xml": PACKAGE_XML.replace("  <depend>geometry_msgs</depend>\n", "").replace(
        "<export>\n", "<export>\n    <depend>geometry_msgs</depend>\n"
    )
}
NAMED = xml("my_robot_controller", "my_robot")
SETUP_NAMED = setup_py('"my_robot_controller"', '"my_robot"')
FOR_PIP = {**MISSING, **setup_py("    packages=", "    install_requires=['geometry_msgs'],\n    packages=")}


@pytest.mark.parametrize(
    ("words", "check", "true", "near"),
    [
        ("package.xml is valid.", "package-xml", {}, xml("</package>")),
        ("The build type is ament_cmake.", "package-xml", CMAKE, {}),
        ("A Python package has the build type ament_python.", "package-xml", CMAKE, {}),
        ("description, maintainer, license and the build type", "package-xml", xml("</package>"), {}),
        ("The build type is missing.", "package-xml", xml("    <build_type>ament_python</build_type>\n"), CMAKE),
        (
            "Without <build_type>ament_python</build_type> in <export>, colcon does not treat the folder as a Python",
            "package-xml",
            CMAKE,
            xml("</package>"),
        ),
        ("The package name in package.xml is my_robot.", "package-name", NAMED, SETUP_NAMED),
        ("The package name in setup.py is my_robot.", "package-name", SETUP_NAMED, NAMED),
        ("package.xml declares rclpy only for building or testing.", "dependencies", ONLY_TESTS, MISSING),
        ("<build_depend> and <test_depend> do not count when the node runs.", "dependencies", ONLY_TESTS, MISSING),
        ("On another computer, rosdep installs only the packages that", "dependencies", MISSING, ONLY_TESTS),
        ("The line is inside a comment, between <!-- and -->", "dependencies", COMMENT, PROSE),
        ("geometry_msgs.msg is a module of the package geometry_msgs. Declare", "dependencies", MODULE, MISSING),
        ("The line is inside <export>, which does not declare", "dependencies", EXPORTED, MISSING),
        (
            "install_requires in setup.py is for pip packages. ROS 2 reads package.xml.",
            "dependencies",
            FOR_PIP,
            MISSING,
        ),
    ],
)
def test_a_sentence_about_package_xml_is_true(words: str, check: str, true: Files, near: Files) -> None:
    assert words in told(of(check, true))
    assert words not in told(of(check, near))


def test_only_the_check_of_the_name_says_which_three_names_are_the_same() -> None:
    words = "package.xml, setup.py and the folder with the Python files have the name my_robot_controller."
    assert words in told(of("package-name", {}))
    assert words not in told(of("package-xml", {}))


@pytest.mark.parametrize(("name", "found"), [("Twist", True), ("twist", False), ("Pose", False)])
def test_a_class_that_is_declared_like_a_package_is_told(name: str, *, found: bool) -> None:
    added = xml("  <depend>rclpy</depend>", f"  <depend>{name}</depend>\n  <depend>rclpy</depend>")
    reported = told(of("dependencies", added))
    assert ("package.xml also declares Twist, which is not a package." in reported) == found
    assert ("Twist is a class in the package geometry_msgs. Declare only packages." in reported) == found
