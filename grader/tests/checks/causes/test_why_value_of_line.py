"""Exceptions whose reason is a value on the line: None, a string in place of a number, a module, or an exit code."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.causes.crash import Crash
from grader.checks.causes.why_crashed import crash_finding
from grader.tests.checks.crashes import DRIVER, reported
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission
from grader.tests.checks.shapes import crashed


@pytest.mark.parametrize(
    ("line", "error", "cause"),
    [
        (
            "self.create_service(SetBool(), 'a', self.send)",
            "NotImplementedError: Service classes can not be instantiated",
            "create_service needs the class itself. A class name with () creates an object: leave out the ().",
        ),
        (
            "self.create_service(RotateAbsolute, 'a', self.send)",
            "RuntimeError: The service type provided is not valid (<class 'turtlesim.action._rotate.A'>)",
            "This is the type of an action. create_service is for services. For an action, use ActionClient.",
        ),
        (
            "self.create_client(Twist, 'a')",
            "RuntimeError: The service type provided is not valid (<class 'geometry_msgs.msg._twist.Twist'>)",
            "This is the type of a message. A service needs the type of a service, such as SetBool.",
        ),
        (
            "ActionClient('driver', RotateAbsolute, 'a')",
            "AttributeError: 'str' object has no attribute 'default_callback_group'",
            "The first argument of ActionClient is the node. Inside a method of the node, write self.",
        ),
        (
            "future.wait()",
            "AttributeError: 'Future' object has no attribute 'wait'",
            "A future has no method wait. Pass the method that needs the result to add_done_callback.",
        ),
        (
            "self.client.call_asinc(step)",
            "AttributeError: 'Client' object has no attribute 'call_asinc'",
            (
                "A similar name exists: call_async. Compare the two names letter by letter, including upper and lower "
                "case."
            ),
        ),
        (
            "self.create_service(SetBool, '/pau se', self.send)",
            "InvalidServiceNameException: Invalid service name",
            (
                'In a service name, use only letters, digits, underscores and slashes. The name here is "/pau se", '
                "with a space."
            ),
        ),
        (
            "self.create_action_client(A, 'a')",
            "AttributeError: 'Driver' object has no attribute 'create_action_client'",
            ("A node has no method for this. Import the class ActionClient from rclpy.action, and call the class."),
        ),
        (
            "step = Request()",
            "NameError: name 'Request' is not defined",
            "Request is a part of a service. Write the name of the type and a dot before it, as in TYPE.Request().",
        ),
        (
            "self.create_service(SetBool, 'a', 'send')",
            "TypeError: 'str' object is not callable",
            "The callback of a service is the method itself. Write self.send without quotation marks.",
        ),
        (
            "for i in 5: pass",
            "TypeError: 'int' object is not iterable",
            "A for loop cannot go through a number. To repeat 5 times, write range(5).",
        ),
        (
            "x, y = msg",
            "TypeError: cannot unpack non-iterable Pose object",
            "This line assigns to several names, but there is only one value, of type Pose.",
        ),
        (
            "x = step > '5'",
            "TypeError: '>' not supported between instances of 'float' and 'str'",
            "A number cannot be compared with a string. float(...) turns a string such as '2.0' into a number.",
        ),
        (
            "x = text * 2.0",
            "TypeError: can't multiply sequence by non-int of type 'float'",
            "A string or a list cannot be multiplied by a number with a decimal point.",
        ),
        (
            "x = math.dist(None, step)",
            "TypeError: 'NoneType' object is not iterable",
            "A value in this line is None. A function without a return statement returns None.",
        ),
        (
            "self.declare_parameter('a'); x = self.get_parameter('a').value + 1.0",
            "TypeError: unsupported operand type(s) for +: 'NoneType' and 'float'",
            "A parameter that is declared without a default value is None. Give declare_parameter a default value.",
        ),
        (
            "self.get_parameters('speed')",
            "ParameterNotDeclaredException: Invalid access to undeclared parameter(s): s",
            "get_parameters takes a list of names. To read one parameter, use get_parameter.",
        ),
        (
            "self.set_parameters({'speed': 1.0})",
            "TypeError: parameter must be instance of type '<class 'rclpy.parameter.Parameter'>'",
            "set_parameters takes a list of objects of the class Parameter.",
        ),
        (
            "self.declare_parameters('', ['speed'])",
            "TypeError: Invalid parameter tuple length at index 0 in parameters list",
            "declare_parameters takes a list of tuples, each with a name and a default value.",
        ),
        (
            "self.publisher.publish(step)",
            "RCLError: Failed to publish: publisher's context is invalid",
            "ROS 2 was used before rclpy.init or after rclpy.shutdown.",
        ),
        (
            "self.create_client(Empty, 'a')",
            "NotInitializedException: no context",
            "rclpy.init is never called. Call it before you create the node.",
        ),
        (
            "self.spin()",
            "AttributeError: 'Driver' object has no attribute 'spin'",
            "spin belongs to the module rclpy, not to the node. Write rclpy.spin.",
        ),
        (
            "rclpy.spin('driver')",
            "AttributeError: 'str' object has no attribute 'executor'",
            "rclpy.spin needs the node, an object of your class. This value is a string.",
        ),
        (
            "x = step(2)",
            "TypeError: 'int' object is not callable",
            (
                "A value of type int is called like a function. Leave out the parentheses after it, or write * to "
                "multiply."
            ),
        ),
        (
            "self.publisher(step)",
            "TypeError: 'Publisher' object is not callable",
            "A value of type Publisher is called like a function. Call its method publish.",
        ),
        (
            "import geometry_msgs.msg.Twist",
            "ModuleNotFoundError: No module named 'geometry_msgs.msg.Twist'",
            (
                "Twist is a class in the module geometry_msgs.msg, not a module. Write from geometry_msgs.msg import "
                "Twist."
            ),
        ),
        (
            "from .shapes import Square",
            "ModuleNotFoundError: No module named 'my_robot_controller.shapes'",
            "The package has no file my_robot_controller/shapes.py.",
        ),
        (
            "open('a.txt')",
            "FileNotFoundError: [Errno 2] No such file or directory: 'a.txt'",
            "No file has this path. A relative path begins at the folder where the program started.",
        ),
    ],
)
def test_a_wrong_value_is_explained(line: str, error: str, cause: str) -> None:
    assert reported(DRIVER.format(line=line), error).cause == cause


def test_none_at_first_is_told_for_an_argument_too() -> None:
    source = DRIVER.replace("self.count = 0", "self.last = None").format(line="x = math.dist(self.last, step)")
    source = source.replace("# crashed\n", "# crashed\n        self.last = step\n")
    found = reported(source, "TypeError: 'NoneType' object is not iterable")
    assert found.cause == "self.last is None until it gets a value. Check for None before you compute with it."


def test_a_missing_import_of_node_is_not_called_a_wrong_letter() -> None:
    source = "class Driver(Node):  # crashed\n    pass\n\ndef main():\n    node = Driver()\n"
    found = reported(source, "NameError: name 'Node' is not defined")
    assert found.cause == "The file does not import Node, which is in the module rclpy.node."


def test_a_call_of_exit_explains_the_exit_code() -> None:
    source = "import sys\n\ndef main():\n    sys.exit(3)\n"
    trial = recording([], end=replace(crashed(0.5), exit_code=3))
    given = evidence(trial, submission({NODE_FILE: source}))
    found = crash_finding(given, Crash("exit code 3", ""), "It ended.", "It runs.")
    assert found.cause == "This call of exit ends the program with this exit code."
    assert (found.where and found.where.line) == 4
    other = crash_finding(given, Crash("exit code 1", ""), "It ended.", "It runs.")
    assert not other.cause


def test_a_callback_of_a_service_creates_a_response() -> None:
    source = DRIVER.replace("self.count = 0", "self.create_service(SetBool, 'a', self.send)")
    found = reported(
        source.format(line="r = SetBool()"), "NotImplementedError: Service classes can not be instantiated"
    )
    assert found.cause.endswith("add .Response before the parentheses.")


@pytest.mark.parametrize(("line", "told"), [("self.spin()", True), ("print(self.ok)", False), ("self.node()", False)])
def test_only_a_called_function_of_rclpy_is_said_to_belong_to_rclpy(line: str, *, told: bool) -> None:
    name = line.partition("self.")[2].strip("()")
    found = reported(DRIVER.format(line=line), f"AttributeError: 'Driver' object has no attribute '{name}'")
    assert ("belongs to the module rclpy" in found.cause) == told
