"""The reasons for exceptions in calls of ROS 2 and NumPy, each with a line or a message that is nearly the same."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, reported

IMPORTS = "import random\nfrom rclpy.node import Node\n"
VALUE = "TypeError: unsupported operand type(s) for /: 'float' and '{}'"
PROPERTY = "TypeError: unsupported operand type(s) for -: 'float' and '{}'"
CARET = "TypeError: unsupported operand type(s) for {}: 'float' and 'float'"
UFUNC = "TypeError: ufunc '{}' not supported for the input types"
TAKES = "TypeError: {}() takes 1 positional argument but 3 were given"
REQUEST = "TypeError: {}.__init__() takes 1 positional argument but 2 were given"
TYPE = "RuntimeError: The service type provided is not valid (<class 'turtlesim.srv._spawn.{}'>), ..."
THIRD = "TypeError: {} element in m at index 0 in parameters list is not a ParameterDescriptor."


@pytest.mark.parametrize(
    ("line", "near", "errors", "words"),
    [
        ("a = b ^ 2", "a = b ^ 2", (CARET.format("^"), CARET.format("|")), "In Python, ^ is not a power. Write x**2"),
        ("a = b ^ 2", "a = b ^ 2", (UFUNC.format("bitwise_xor"), UFUNC.format("sin")), "In Python, ^ is not a power."),
        (
            "a = 1.0 / self.get_parameter('r').get_parameter_value()",
            "a = 1.0 / self.get_parameter('r')",
            (VALUE.format("ParameterValue"), VALUE.format("Parameter")),
            "get_parameter_value returns a ParameterValue, which is a message. The field double_value has the float.",
        ),
        (
            "self.declare_parameter('r', '1.8')",
            "self.declare_parameter('r', 'fast')",
            (VALUE.format("str"), VALUE.format("str")),
            "The default value of the parameter r is a string. Write 1.8 without quotation marks.",
        ),
        (
            "a = 1 / self.get_parameter('r').get_parameter_value().integer_value",
            "a = 1 / self.get_parameter('r').get_parameter_value().double_value",
            ("ZeroDivisionError: division by zero", "ZeroDivisionError: division by zero"),
            "integer_value is 0 if the parameter is a float. The number is then in double_value.",
        ),
        (
            "a = np.column_stack(b, c)",
            "a = np.row_stack(b, c)",
            (TAKES.format("column_stack"), TAKES.format("row_stack")),
            "This call passes 2. Put the arrays into a tuple: column_stack((a, b)).",
        ),
        (
            "a = Kill.Request(name)",
            "a = Driver(name)",
            (REQUEST.format("Kill_Request"), REQUEST.format("Driver")),
            "Create the message without arguments, then set its fields one by one.",
        ),
        (
            "self.create_client(Spawn.Request, '/spawn')",
            "self.create_client(Spawn.Request, '/spawn')",
            (TYPE.format("Spawn_Request"), TYPE.format("Spawning")),
            "Pass the type Spawn itself, not Spawn.Request.",
        ),
        (
            "a = random(1.0, 10.0)",
            "a = self.random(1.0, 10.0)",
            ("TypeError: 'module' object is not callable", "TypeError: 'module' object is not callable"),
            "random is a module. Write the name of one of its functions after a dot.",
        ),
        (
            "self.declare_parameter('r', 1.8, 'in m')",
            "self.declare_parameters('', [('r', 1.8, 'in m')])",
            (THIRD.format("Third"), THIRD.format("Third")),
            "The third argument of declare_parameter is a ParameterDescriptor. The description is one of its fields.",
        ),
        (
            "self.client.cancel_goal_async()",
            "self.client.cancel()",
            tuple(
                f"AttributeError: 'ActionClient' object has no attribute '{name}'"
                for name in ("cancel_goal_async", "cancel")
            ),
            "cancel_goal_async is a method of the goal handle, not of the client.",
        ),
        (
            "self.client = ActionServer(self, Turn, '/turn')",
            "self.client = Turner(self, Turn, '/turn')",
            tuple(
                f"TypeError: {name}.__init__() missing 1 required positional argument: 'execute_callback'"
                for name in ("ActionServer", "Turner")
            ),
            "'execute_callback'. A node that sends goals needs an ActionClient.",
        ),
        (
            "self.send(answer.result().name)",
            "self.send(answer.result().name)",
            tuple(
                f"AttributeError: '{name}' object has no attribute 'name'" for name in ("Kill_Response", "Kill_Answer")
            ),
            "The response of Kill has no field name. The command ros2 interface show prints the fields.",
        ),
        (
            "a = step - Pose.x",
            "a = step - Pose.x",
            (PROPERTY.format("property"), PROPERTY.format("complex")),
            "A class is used in place of a message: its fields have no values. Check upper and lower case in names.",
        ),
        (
            "raise ValueError('too fast')",
            "int('too fast')",
            ("ValueError: too fast", "ValueError: too fast"),
            "This line raises the exception itself. An exception that nothing catches ends the program.",
        ),
        (
            "await self.count",
            "await self.count",
            ("SyntaxError: 'await' outside async function", "SyntaxError: 'return' outside function"),
            "await is allowed only in a function that begins with async def. Instead of waiting, pass the next step to",
        ),
        (
            "self.left.remove(step)",
            "self.left.index(step)",
            ("ValueError: list.remove(x): x not in list", "ValueError: 1 is not in list"),
            "remove needs an item that is equal to one in the list, and the list has no such item.",
        ),
    ],
)
def test_the_line_and_the_message_decide(line: str, near: str, errors: tuple[str, str], words: str) -> None:
    assert words in reported(IMPORTS + DRIVER.format(line=line), errors[0]).cause
    assert words not in reported(IMPORTS + DRIVER.format(line=near), errors[1]).cause


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("msg.x, msg.y = 2, 9.0", "The field x is a float, but 2 is an integer."),
        ("msg.x, msg.y = 2.0, step", "The field x is a float, but the value has another type."),
        ("msg.x, msg.y = step", "The field x is a float, but the value has another type."),
    ],
)
def test_a_field_gets_its_value_from_the_same_place_of_a_tuple(value: str, words: str) -> None:
    given = reported(DRIVER.format(line=value), "AssertionError: The 'x' field must be of type 'float'")
    assert given.cause.startswith(words)


POSE = """\
class Driver(Node):
    def __init__(self):
        self.pose = None

    def heard(self, pose):
        self.pose = pose

    def send(self):
        {before}
        print(self.pose.x)  # crashed
"""
FIRST = "self.pose is None until it gets a value. Check for None before you use the value."
CLEARED = "Line 9 sets self.pose to None, and the next line uses it."
REVERSED = "This condition is reversed: the function returns if self.pose is not None."


@pytest.mark.parametrize(
    ("before", "words"),
    [
        ("pass", FIRST),
        ("self.pose = None", CLEARED),
        ("self.pose = 3", FIRST),
        ("if self.pose is not None:\n            return", REVERSED),
        ("if self.pose is not None:\n            pass", FIRST),
    ],
)
def test_a_pose_of_none_is_too_early_cleared_or_checked_the_wrong_way_round(before: str, words: str) -> None:
    given = reported(POSE.format(before=before), "AttributeError: 'NoneType' object has no attribute 'x'")
    assert [each for each in (FIRST, CLEARED, REVERSED) if each == given.cause] == [words]


@pytest.mark.parametrize(
    ("names", "words"),
    [
        ("success", "The message has no field success. Check the name letter by letter."),
        ("a b", "Create the message without arguments, then set its fields one by one."),
    ],
)
def test_an_argument_that_is_no_field_is_named(names: str, words: str) -> None:
    error = f"AssertionError: Invalid arguments passed to constructor: {names}"
    assert reported(DRIVER.format(line="a = Result(success=True)"), error).cause == words


CHECK = """\
class Driver(Node):
    def __init__(self):
        self.{add}(self.check)

    def check(self, parameters):
        raise ValueError("too fast")  # crashed
"""


@pytest.mark.parametrize(("add", "found"), [("add_on_set_parameters_callback", True), ("create_timer", False)])
def test_only_the_callback_of_parameters_refuses_values(add: str, *, found: bool) -> None:
    cause = reported(CHECK.format(add=add), "ValueError: too fast").cause
    words = "To refuse a value, do not raise an exception. Return a SetParametersResult with successful=False."
    assert (words in cause) == found
