"""The sentences about a segmentation fault, each with nodes that are nearly the same and have no cause."""

from __future__ import annotations

import pytest

from grader.checks.causes.crash import crash_of
from grader.checks.causes.why_crashed import crash_finding
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission
from grader.trial.recording import ProcessEnd

HEAD = """\
import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient, ActionServer
from rclpy.node import Node
from turtlesim.action import RotateAbsolute
from turtlesim.srv import Spawn
"""
SOURCE = (
    HEAD
    + """

class Lookout(Node):
    def __init__(self):
        super().__init__("lookout")
        {line}  # look

    def turn(self):
        pass


def main():
    rclpy.init()
    rclpy.spin(Lookout())
"""
)
CLIENT = 'self.client = ActionClient(self, Twist, "/turtle1/rotate_absolute")'
RIGHT = CLIENT.replace("Twist", "RotateAbsolute")
CRASHES = "rclpy does not check this, and crashes."
MESSAGE = f"Twist is the type of a message. ActionClient needs the type of an action. {CRASHES}"


def cause(source: str, exit_code: int = -11, files: dict[str, str] | None = None) -> tuple[str, str | None, int | None]:
    """Return the cause in words, the diagnosis, and the line of the report of a node that ended with this code."""
    end = ProcessEnd(by="itself", exit_code=exit_code, t_s=0.0, stop_s=None)
    given = evidence(recording([], end=end), submission({NODE_FILE: source, **(files or {})}))
    crash = crash_of(given)
    assert crash is not None
    finding = crash_finding(given, crash, "It crashed.", "It runs.")
    return finding.cause, finding.diagnosis, None if finding.where is None else finding.where.line


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (CLIENT, MESSAGE),
        (CLIENT.replace("Twist, ", "action_name=").replace(")", ", action_type=Twist)"), MESSAGE),
        (CLIENT.replace("Twist", "Twist()"), MESSAGE),
        (CLIENT.replace("Twist", "Spawn"), MESSAGE.replace("Twist", "Spawn").replace("message", "service")),
        (CLIENT.replace("Twist", "Spawn.Request"), MESSAGE.replace("Twist", "Spawn").replace("message", "service")),
        (
            CLIENT.replace("Twist", "RotateAbsolute.Goal"),
            "ActionClient needs the whole type of the action, RotateAbsolute, and not RotateAbsolute.Goal. " + CRASHES,
        ),
        (
            'self.server = ActionServer(self, Twist, "/turn", self.turn)',
            MESSAGE.replace("ActionClient", "ActionServer"),
        ),
    ],
)
def test_a_client_or_server_of_an_action_with_another_type_is_named(line: str, words: str) -> None:
    source = SOURCE.format(line=line)
    assert cause(source) == (words, "wrong-type", line_with(LOOK, source))


@pytest.mark.parametrize(
    "source",
    [
        SOURCE.format(line=RIGHT),
        SOURCE.format(line=f"if self.count_publishers('/x'):\n            {CLIENT}"),
        SOURCE.format(line=f"self.make = lambda: {CLIENT.partition(' = ')[2]}"),
        SOURCE.format(line=RIGHT).replace("pass", CLIENT),
        SOURCE.format(line=CLIENT).replace("Lookout())", "Node('lookout'))"),
        SOURCE.format(line=CLIENT).replace("import rclpy\n", "import ctypes\nimport rclpy\n"),
        SOURCE.format(line=CLIENT).replace("class Lookout", "Twist = RotateAbsolute\n\n\nclass Lookout"),
        SOURCE.format(line=CLIENT).replace("__init__(self)", "__init__(self, Twist=RotateAbsolute)"),
        SOURCE.format(line=CLIENT).replace("import Twist", "import Vector3 as Twist"),
        SOURCE.format(line=CLIENT).replace("geometry_msgs.msg import Twist", "turtlesim.action import Twist"),
        SOURCE.format(line=CLIENT).replace("rclpy.action import", "my_robot_controller.clients import"),
        SOURCE.format(line=CLIENT).replace("geometry_msgs.msg", "my_robot_controller.msg"),
        SOURCE.format(line="self.client = ActionClient(*self.turn())"),
    ],
)
def test_a_segmentation_fault_with_another_reason_has_no_such_cause(source: str) -> None:
    assert CRASHES not in cause(source, files={"my_robot_controller/msg.py": "from turtlesim.action import Twist\n"})[0]


def test_another_end_of_the_program_has_no_such_cause() -> None:
    assert CRASHES not in cause(SOURCE.format(line=CLIENT), exit_code=-6)[0]
