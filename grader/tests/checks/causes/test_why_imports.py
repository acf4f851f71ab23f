"""The causes of a failed import."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported
from grader.tests.checks.made import PACKAGE_XML

HELPER = {"my_robot_controller/helper.py": "", "my_robot_controller/unhelper.py": ""}


@pytest.mark.parametrize(
    ("error", "diagnosis", "words"),
    [
        ("No module named 'rospy'", "ros-1-module", "rospy belongs to ROS 1."),
        ("No module named 'tf.transformations'", "ros-1-module", "tf belongs to ROS 1."),
        ("No module named 'turtlesim_msgs'", "turtlesim-msgs", "Newer ROS 2 distributions have"),
        ("No module named 'turtlesim_msgs.msg'", "turtlesim-msgs", "Newer ROS 2 distributions have"),
        ("No module named 'helper'", "sibling-import", "my_robot_controller/helper.py exists, but"),
        (
            "No module named 'my_robot_controller.helpers'",
            "module-misspelt",
            "A similar module exists: my_robot_controller.helper.",
        ),
        ("No module named 'geometry_msg.msg'", "module-misspelt", "A similar module exists: geometry_msgs.msg."),
        (
            "No module named 'cv2'",
            "module-missing",
            "No installed package has a module cv2. Check the name letter by letter. If the name is right, the grader",
        ),
        (
            "cannot import name 'twist' from 'geometry_msgs.msg' (unknown)",
            "import-name",
            "In this module the name is Twist.",
        ),
        (
            "cannot import name 'Twist' from 'turtlesim.msg'",
            "import-wrong-place",
            "Twist is in the module geometry_msgs.msg.",
        ),
        (
            "cannot import name 'Twists' from 'geometry_msgs.msg'",
            "import-name",
            "The module geometry_msgs.msg has no such name, but it has Twist.",
        ),
        (
            "cannot import name 'Banana' from 'geometry_msgs.msg'",
            "import-name",
            "The module geometry_msgs.msg has no such name",
        ),
        (
            "cannot import name 'SetBoolResponse' from 'std_srvs.srv'",
            "import-name",
            "SetBoolResponse is the name in ROS 1. In ROS 2, import SetBool: its Response is an attribute.",
        ),
        (
            "cannot import name 'SetBoolResponse' from 'std_srvs.msg'",
            "import-name",
            "The module std_srvs.msg has no such name",
        ),
        (
            "No module named 'tkinter'",
            "module-missing",
            "tkinter is Python's module for graphical windows. This grader does not have tkinter, so it",
        ),
        (
            "No module named 'rosidl_runtime_py'",
            "module-missing",
            "rosidl_runtime_py is a package of ROS 2. This grader does not have rosidl_runtime_py, so it cannot run",
        ),
        ("No module named 'tkinter.mesages'", "module-missing", "No installed package has a module tkinter.mesages."),
        ("DLL load failed", "crash", "Python could not do this import. The message of the exception gives the reason."),
        (
            "attempted relative import with no known parent package",
            "crash",
            "A dot at the beginning of a module name stands for the package that contains this file.",
        ),
    ],
)
def test_a_failed_import_is_explained_by_what_there_is(error: str, diagnosis: str, words: str) -> None:
    found = reported("import this_and_that  # crashed\n", f"ImportError: {error}", HELPER)
    assert (found.diagnosis, found.line) == (diagnosis, 1)
    assert found.cause.startswith(words)


@pytest.mark.parametrize(
    ("module", "declared", "words"),
    [
        ("dove", "dove", "The grader does not have the package dove. If the package is your own,"),
        ("dove.msg", "dove", "The grader does not have the package dove."),
        ("dove_interfaces", "turtlesim", "The grader does not have the package dove_interfaces."),
        ("dove_msgs", "turtlesim", "The grader does not have the package dove_msgs."),
        ("dove", "raven", "No installed package has a module dove. Check the name letter by letter."),
        ("turtlesim.mgs", "turtlesim", "A similar module exists: turtlesim.msg."),
        ("geometry_mgs.msg", "turtlesim", "A similar module exists: geometry_msgs.msg."),
    ],
)
def test_a_package_that_was_not_handed_in_is_not_misspelt(module: str, declared: str, words: str) -> None:
    manifest = PACKAGE_XML.replace("<depend>rclpy</depend>", f"<depend>rclpy</depend>\n  <depend>{declared}</depend>")
    assert manifest != PACKAGE_XML
    found = reported("import this  # crashed\n", f"ImportError: No module named '{module}'", {"package.xml": manifest})
    assert (found.diagnosis in ("module-missing", "module-misspelt"), found.cause.startswith(words)) == (True, True)
