"""The causes of an AttributeError."""

from __future__ import annotations

import pytest

from grader.checks.causes.no_entry_point import indented
from grader.submission.code import read_module
from grader.tests.checks.crashes import DRIVER, reported, to_look_at


@pytest.mark.parametrize(
    ("error", "diagnosis", "words"),
    [
        ("module 'rclpy' has no attribute 'Node'", "import-wrong-place", "Node is in the module rclpy.node."),
        (
            "module 'geometry_msgs' has no attribute 'Twist'",
            "import-wrong-place",
            "Twist is in the module geometry_msgs.msg.",
        ),
        ("module 'math' has no attribute 'Node'", "attribute-missing", "The module math does not contain this name."),
        ("module 'rclpy' has no attribute 'spni'", "attribute-misspelt", "A similar name exists: spin."),
        ("module 'rclpy' has no attribute 'Spin'", "attribute-misspelt", "A similar name exists: spin."),
        (
            "module 'rclpy' has no attribute 'turtle'",
            "attribute-missing",
            "The module rclpy does not contain this name.",
        ),
        ("module 'math' has no attribute 'PI'", "attribute-misspelt", "A similar name exists: pi."),
        ("module 'time' has no attribute 'sleeep'", "attribute-misspelt", "A similar name exists: sleep."),
        ("module 'cv2' has no attribute 'imred'", "attribute-missing", "The module cv2 does not contain this name."),
        ("type object 'Twist' has no attribute 'linear'", "class-for-object", "Twist is a class."),
        (
            "type object 'GoalStatus' has no attribute 'STATUS_CANCELLED'",
            "attribute-misspelt",
            "A similar name exists: STATUS_CANCELED.",
        ),
        (
            "type object 'Kill_Request' has no attribute 'turtle'",
            "attribute-missing",
            "The class Kill_Request has no constant or method with that name.",
        ),
        ("'Metaclass_Twist' object has no attribute 'linear'", "class-for-object", "Twist is a class."),
        ("'function' object has no attribute 'now'", "not-called", "the parentheses after its name are missing"),
        (
            "'Twist' object has no attribute 'liner'",
            "message-field",
            "A Twist of geometry_msgs has linear and angular. Did you mean linear?",
        ),
        ("'Twist' object has no attribute 'speed'", "message-field", "A Twist of geometry_msgs has linear"),
        ("'Publisher' object has no attribute 'publsh'", "attribute-misspelt", "A similar name exists: publish."),
        (
            "'Publisher' object has no attribute 'send'",
            "attribute-missing",
            "Publisher objects have no attribute or method with that name.",
        ),
        ("'RcutilsLogger' object has no attribute 'Info'", "attribute-misspelt", "A similar name exists: info."),
        ("'str' object has no attribute 'speed'", "attribute-missing", "This value is a string,"),
        ("no attribute at all", "crash", ""),
    ],
)
def test_an_unknown_attribute_is_explained_by_what_it_was_looked_for_in(error: str, diagnosis: str, words: str) -> None:
    source = DRIVER.format(line="self.drive()")
    found = reported(source, f"AttributeError: {error}")
    assert (found.diagnosis, found.line) == (diagnosis, to_look_at(source))
    assert words in found.cause
    assert ("meant?" in found.cause) == ("meant?" in words)
    assert "Metaclass" not in found.cause
    assert ("Add parentheses" in found.cause) == (diagnosis == "class-for-object")


def test_a_message_made_without_parentheses_is_reported_where_it_was_made() -> None:
    source = "count = 3\nmsg = geometry_msgs.msg.Twist  # look\nmsg.linear.x = 2.0  # crashed\n"
    found = reported(source, "AttributeError: 'property' object has no attribute 'x'")
    assert (found.diagnosis, found.line) == ("class-for-object", 2)
    assert "geometry_msgs.msg.Twist is a class." in found.cause


def test_a_class_that_no_line_assigns_is_reported_where_it_crashed() -> None:
    found = reported(
        "count = 3\nmsg.linear.x = 2.0  # crashed\n", "AttributeError: 'property' object has no attribute 'x'"
    )
    assert (found.diagnosis, found.line) == ("class-for-object", 2)
    assert "This line uses a class instead of an object." in found.cause


def test_a_pose_of_another_package_is_not_described_by_the_fields_of_turtlesims_pose() -> None:
    error = "AttributeError: 'Pose' object has no attribute 'theta'"
    found = reported("pose = Pose()\nprint(pose.theta)  # crashed\n", error)
    assert found.cause == "This is a Pose of another package, which has other fields."


def none_error(name: str) -> str:
    return f"AttributeError: 'NoneType' object has no attribute '{name}'"


@pytest.mark.parametrize(
    ("first", "diagnosis"),
    [
        ("self.pose = None", "none-before-message"),
        ("self.pose = 3", "attribute-missing"),
        ("self.pose = look_up()", "attribute-missing"),
        ("self.other = None", "attribute-missing"),
    ],
)
def test_what_no_message_has_filled_is_none(first: str, diagnosis: str) -> None:
    source = f"class Driver:\n    def __init__(self):\n        {first}\n    def send(self):\n"
    source += "        self.other.y = make().x + self.pose.x  # crashed\n"
    found = reported(source, none_error("x"))
    assert found.diagnosis == diagnosis
    assert ("self.pose is None until" in found.cause) == (diagnosis == "none-before-message")


def test_the_function_that_was_called_with_none_instead_of_a_node_is_named() -> None:
    found = reported("executor.add_node(make())  # crashed\n", none_error("executor"))
    assert found.cause == "executor.add_node was called with None instead of a node."


def test_spin_wants_a_node() -> None:
    assert reported("rclpy.spin(make())  # crashed\n", none_error("executor")).diagnosis == "no-object"


LOCAL = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        speed = 2.0  # look

    def send(self):
        print(self.speed)  # crashed
"""
COMPARED = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.speed == 2.0  # crashed
"""
BASE = """\
class Base(Node):
    def start_again(self):
        pass

class Driver(Base):
    def send(self):
        self.start_agian()  # crashed
"""


def test_a_value_that_is_none_is_reported_as_none() -> None:
    found = reported("def drive():\n    publisher.publish(1)  # crashed\n", none_error("publish"))
    assert "publisher is None here" in found.cause


OWN = "AttributeError: 'Driver' object has no attribute '{}'"
TOO_EARLY = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.send()
        self.count = 0
    def send(self):
        self.count += 1  # crashed
    def again(self):
        self.count = 2
"""
OUTSIDE = """\
class Driver(Node):
    def __init__(self):
        self.create_timer(0.5, self.send)  # crashed

def send(self):  # look
    pass
"""
INSIDE = """\
class Driver(Node):
    def __init__(self):
        self.create_timer(0.5, self.send)  # crashed

        def send(self):  # look
            pass
"""
ELSEWHERE = """\
class Driver(Node):
    def __init__(self):
        self.create_timer(0.5, self.send)  # crashed

class Other(Node):
    def send(self):
        pass
"""
NO_SUPER = """\
class Driver(Node):
    def send(self):
        pass
    def __init__(self):  # look
        print("driver")
        self.create_timer(0.5, self.send)  # crashed
"""
LATE_SUPER = """\
class Driver(Node):
    def __init__(self):
        self.create_timer(0.5, self.send)  # crashed
        super().__init__("driver")
"""
NO_INIT = "class Driver(Node):\n    def send(self):\n        print(self._x)  # crashed\n"


@pytest.mark.parametrize(
    ("source", "name", "diagnosis", "words"),
    [
        (TOO_EARLY, "count", "attribute-too-early", "self.count is assigned on line 5,"),
        (OUTSIDE, "send", "method-outside-class", "send is outside the class."),
        (INSIDE, "send", "method-in-method", "send is indented too far"),
        (ELSEWHERE, "send", "attribute-missing", "self.send is never assigned,"),
        (NO_SUPER, "_timers", "super-init-missing", "never calls super().__init__"),
        (LATE_SUPER, "_timers", "super-init-late", "before that line"),
        (NO_INIT, "_x", "attribute-missing", "self._x is never assigned,"),
        (ELSEWHERE, "publish", "node-publishes", "A node has no method publish"),
        (ELSEWHERE, "create_timmer", "attribute-misspelt", "A similar name exists: create_timer."),
        (TOO_EARLY, "agian", "attribute-misspelt", "A similar name exists: again."),
        (TOO_EARLY, "conut", "attribute-misspelt", "A similar name exists: count."),
        (LOCAL, "speed", "missing-self", "Line 4 assigns speed without self"),
        (COMPARED, "speed", "equals", "== compares two values."),
        (BASE, "start_agian", "attribute-misspelt", "A similar name exists: start_again."),
        (TOO_EARLY, "velocity", "attribute-missing", "self.velocity is never assigned,"),
    ],
)
def test_what_a_node_lacks_is_explained_by_its_class(source: str, name: str, diagnosis: str, words: str) -> None:
    found = reported(source, OWN.format(name))
    assert (found.diagnosis, found.line) == (diagnosis, to_look_at(source))
    assert words in found.cause


@pytest.mark.parametrize(
    ("name", "diagnosis"), [("_Node__node", "super-init-missing"), ("_Driver__node", "attribute-missing")]
)
def test_an_attribute_of_rclpy_with_two_underscores_is_not_the_students(name: str, diagnosis: str) -> None:
    source = DRIVER.replace('        super().__init__("driver")\n', "").format(line="self.create_timer(1.0, print)")
    assert reported(source, f"AttributeError: 'Driver' object has no attribute '{name}'").diagnosis == diagnosis


@pytest.mark.parametrize(
    ("first", "line"),
    [
        ("msg = Twist  # look", "msg.linar.x = 1.0"),
        ("msg = Twist()", "Twist.linar.x = 1.0"),
        ("other = Twist", "msg.linar.x = 1"),
    ],
)
def test_a_class_that_was_assigned_is_reported_there(first: str, line: str) -> None:
    source = DRIVER.format(line=f"{first}\n        {line}")
    found = reported(source, "AttributeError: type object 'Twist' has no attribute 'linar'")
    assert (found.diagnosis, found.line) == ("class-for-object", to_look_at(source))


MAIN = """\
from geometry_msgs.msg import *
from rclpy.node import Node

class Driver(Node):
    pass

{indent}def main(): {mark}
{indent}    pass
"""


@pytest.mark.parametrize(
    ("name", "indent", "diagnosis"),
    [("main", "    ", "main-in-class"), ("main", "", "entry-point-function"), ("run", "    ", "attribute-missing")],
)
def test_a_function_of_the_entry_point_may_be_inside_the_class(name: str, indent: str, diagnosis: str) -> None:
    source = MAIN.format(indent=indent, mark="# look")
    told = reported(source, f"AttributeError: module 'my_robot_controller.draw_circle' has no attribute '{name}'")
    assert told.diagnosis == diagnosis
    assert ("main is indented, so it belongs to the class above it." in told.cause) == (diagnosis == "main-in-class")


@pytest.mark.parametrize(
    ("before", "above"),
    [
        ("class A:\n", "the class above it"),
        ("class A:\n    pass\ndef run():\n", "the function run above it"),
        ("class A:\n    pass\nif __name__ == '__main__':\n", "the block that begins on line 3"),
        ("class A:\n    pass\nmatch 1:\n  case 1:\n", "the block that begins on line 4"),
    ],
)
def test_an_indented_function_belongs_to_what_is_above_it(before: str, above: str) -> None:
    module = read_module("node.py", f"{before}    def main():\n        pass\n".encode())
    cause = indented(module, "main")
    assert cause is not None
    assert cause.text == f"main is indented, so it belongs to {above}. Remove the indentation."
