"""The reasons why rclpy or a message class rejected an argument, each with a call that is nearly the same."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, reported

HANDLE = "AttributeError: 'float' object has no attribute 'handle'"
ENTITY = "TypeError: CallbackGroup.add_entity() missing 1 required positional argument: 'entity'"
POSITION = "TypeError: Vector3Stamped.__init__() takes 1 positional argument but 3 were given"
SUBSCRIPT = "TypeError: 'Pose' object is not subscriptable"
DEFAULT = "TypeError: The given value is not one of the allowed types '<{} object at 0x7f>'."
TWICE = "rclpy.exceptions.ParameterAlreadyDeclaredException: Parameter(s) already declared: ['radius']"


@pytest.mark.parametrize(
    ("line", "error", "words", "there"),
    [
        ("self.create_timer(0.5, self.send, 2.0, 1.0)", HANDLE, "A timer passes no arguments to its callback.", True),
        ("self.create_timer(0.5, self.send)", HANDLE, "A timer passes no arguments to its callback.", False),
        (
            "self.create_timer(0.5, self.send, callback_group=ReentrantCallbackGroup)",
            ENTITY,
            "ReentrantCallbackGroup is a class. Add parentheses after the class name to create an object.",
            True,
        ),
        ("self.create_timer(0.5, self.send, callback_group=self.group)", ENTITY, "is a class", False),
        (
            "self.create_timer(0.5, self.send, ReentrantCallbackGroup)",
            ENTITY,
            "ReentrantCallbackGroup is a class. Add parentheses after the class name to create an object.",
            True,
        ),
        ("self.create_timer(0.5, self.send, ReentrantCallbackGroup)", ENTITY, "A timer passes no arguments", False),
        (
            "self.create_client(Kill, 'kill', callback_group=ReentrantCallbackGroup)",
            ENTITY,
            "ReentrantCallbackGroup is a class.",
            True,
        ),
        ("print(pose['x'])", SUBSCRIPT, "A Pose is a message, not a dictionary.", True),
        ("print(pose['x'])", SUBSCRIPT.replace("Pose", "Place"), "is a message, not a dictionary", False),
        ("Vector3Stamped(1.0, 2.0)", POSITION, "Create the message without arguments", True),
        ("Vector3Stamped(1.0, 2.0)", POSITION.replace("Vector3Stamped", "Driver"), "Create the message", False),
        (
            'self.declare_parameter("radius", Parameter("radius"))',
            DEFAULT.format("rclpy.parameter.Parameter"),
            "The second argument of declare_parameter is the default value, such as 1.0. Here it is a Parameter.",
            True,
        ),
        (
            'self.declare_parameter("radius", Twist())',
            DEFAULT.format("Twist"),
            "Here it is an object of another type.",
            True,
        ),
        ('self.declare_parameter("radius", Twist())', "TypeError: another", "is the default value, such as", False),
        (
            'self.set_parameters([Parameter("radius", value=pose)])',
            DEFAULT.format("Pose"),
            "is the default value, such as",
            False,
        ),
        (
            'self.declare_parameter("radius", Parameter("radius", value=pose))',
            DEFAULT.format("Pose"),
            "is the default value, such as",
            False,
        ),
        ('self.declare_parameter("radius", 1.0)', TWICE, "radius is declared twice. Compare the names", True),
        (
            'self.declare_parameter("use_sim_time", True)',
            TWICE.replace("radius", "use_sim_time"),
            "rclpy already declares use_sim_time for every node. Do not declare it again.",
            True,
        ),
        ('self.declare_parameter("radius", 1.0)', "KeyError: 'radius'", "is declared twice", False),
        (
            "self.client.send_goal(goal, done_cb=self.send)",
            "TypeError: ActionClient.send_goal_async() got an unexpected keyword argument 'done_cb'",
            "done_cb, active_cb and feedback_cb belong to actionlib, a library of ROS 1.",
            True,
        ),
        (
            "self.client.send_goal(goal, done=self.send)",
            "TypeError: ActionClient.send_goal_async() got an unexpected keyword argument 'done'",
            "belong to actionlib",
            False,
        ),
    ],
)
def test_an_argument_of_the_wrong_kind_is_told(line: str, error: str, words: str, *, there: bool) -> None:
    source = "from geometry_msgs.msg import Vector3Stamped\nfrom turtlesim.msg import Pose\n"
    source += DRIVER.replace("{line}", line)
    assert (words in reported(source, error).cause) == there


AUTOMATIC = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver", {argument})
        self.declare_parameter("radius", 1.0)  # crashed
"""


@pytest.mark.parametrize(
    ("argument", "line", "words"),
    [
        ("automatically_declare_parameters_from_overrides=True", 3, "already declares each parameter that is set when"),
        ("automatically_declare_parameters_from_overrides=False", 4, "radius is declared twice."),
        ("allow_undeclared_parameters=True", 4, "radius is declared twice."),
    ],
)
def test_a_parameter_may_be_declared_by_an_argument_of_the_node(argument: str, line: int, words: str) -> None:
    found = reported(AUTOMATIC.format(argument=argument), TWICE)
    assert (words in found.cause, found.line) == (True, line)


LISTENER = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.{maker}(self.check)

    def check(self, parameters):
        self.speed = parameters.value  # crashed
"""


@pytest.mark.parametrize(
    ("maker", "told"), [("add_on_set_parameters_callback", True), ("add_post_set_parameters_callback", False)]
)
def test_the_callback_for_parameters_gets_a_list(maker: str, *, told: bool) -> None:
    found = reported(LISTENER.format(maker=maker), "AttributeError: 'list' object has no attribute 'value'")
    assert ("check gets a list of parameters, even if only one is set." in found.cause) == told
