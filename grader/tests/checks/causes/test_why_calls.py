"""The reasons why Python or rclpy rejected a call."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported, to_look_at

NODE = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.count = 0
        {line}  # crashed

    def send(self):
        pass

    def take(self, msg):
        pass

    def turn(angle):
        pass
"""
HIDES = """\
class Driver(Node):
    def __init__(self):
        self.count = 0
        self.send = 3  # look
        self.create_timer(0.5, self.send)

    def send(self):
        self.send()  # crashed
"""
QUEUE = "The last argument is the queue size, a whole number"


@pytest.mark.parametrize(
    ("line", "diagnosis"),
    [
        ("self.create_timer(0.5, self.send())", "callback-called"),
        ("self.create_timer(0.5, callback=self.send())", "callback-called"),
        ('self.create_subscription(Pose, "/turtle1/pose", self.take(), 10)', "callback-called"),
        ('self.create_service(Spawn, "/spawn", self.take())', "callback-called"),
        ("self.create_timer(0.5, make())", "crash"),
        ("self.create_timer(0.5, self.send)", "crash"),
        ("self.create_timer(0.5)", "crash"),
        ("self.create_timer(self.send, 0.5)", "arguments-swapped"),
        ('self.create_publisher("/turtle1/cmd_vel", Twist, 10)', "arguments-swapped"),
        ('self.create_publisher(10, "/turtle1/cmd_vel", Twist)', "arguments-swapped"),
        ('self.create_subscription(Pose, self.take, "/turtle1/pose", 10)', "arguments-swapped"),
        ('self.create_subscription("/turtle1/pose", turtlesim.Pose, self.take, 10)', "crash"),
        ('self.create_publisher("/turtle1/cmd_vel", "Twist", 10)', "crash"),
        ('self.create_publisher(Twist, "/turtle1/cmd_vel")', "crash"),
        ('self.create_publisher("/turtle1/cmd_vel", Twist)', "crash"),
        ("self.create_timer(self.count, 0.5)", "crash"),
        ("self.create_timer(make(), 0.5)", "crash"),
    ],
)
def test_a_line_that_makes_something_shows_what_is_wrong_with_its_arguments(line: str, diagnosis: str) -> None:
    source = NODE.format(line=line)
    found = reported(source, "TypeError: the words do not matter")
    assert (found.diagnosis, found.line) == (diagnosis, to_look_at(source))


def test_the_order_is_reported_for_the_function_that_was_called() -> None:
    found = reported(NODE.format(line="self.create_timer(self.send, 0.5)"), "TypeError: no")
    assert found.cause == "create_timer takes its arguments in this order: the period and the callback."
    found = reported(NODE.format(line="self.create_timer(0.5, self.send())"), "TypeError: no")
    assert found.cause.startswith("create_timer needs the method itself.")


def test_a_call_over_several_lines_is_shown_where_it_begins() -> None:
    for arguments in ("0.5, self.send()", "self.send, 0.5"):
        source = NODE.format(line=f"self.create_timer(  # look\n            {arguments})")
        assert reported(source, "TypeError: no").line == to_look_at(source)


@pytest.mark.parametrize(
    ("error", "diagnosis", "look", "words"),
    [
        (
            "Driver.take() missing 1 required positional argument: 'msg'",
            "callback-parameters",
            "def take",
            "Nothing is passed for 'msg'.",
        ),
        (
            "Node.__init__() missing 1 required positional argument: 'node_name'",
            "node-name-missing",
            "",
            "Pass the node name",
        ),
        (
            "Node.create_publisher() missing 1 required positional argument: 'qos_profile'",
            "argument-missing",
            "",
            "create_publisher takes the type, the topic and the queue size.",
        ),
        (
            "Driver.__init__() missing 2 required positional arguments: 'a' and 'b'",
            "callback-parameters",
            "def __init__",
            "Nothing is passed for 'a' and 'b'.",
        ),
        (
            "fill() missing 1 required keyword-only argument: 'node_name'",
            "argument-missing",
            "",
            "fill needs another argument: 'node_name'.",
        ),
        (
            "fill() missing 2 required keyword-only arguments: 'x' and 'y'",
            "argument-missing",
            "",
            "fill needs more arguments: 'x' and 'y'.",
        ),
        (
            "Twist.__init__() takes 1 positional argument but 3 were given",
            "message-arguments",
            "",
            "Create the message without arguments,",
        ),
        (
            "Driver.__init__() takes 1 positional argument but 3 were given",
            "callback-parameters",
            "def __init__",
            "__init__ is called with an argument but has no parameter for",
        ),
        (
            "Twist.send() takes 1 positional argument but 2 were given",
            "callback-parameters",
            "def send",
            "send is called with an argument but has no parameter for",
        ),
        (
            "Driver.take() takes 2 positional arguments but 3 were given",
            "callback-parameters",
            "def take",
            "take is called with an argument but has no parameter for",
        ),
        (
            "Driver.turn() takes 1 positional argument but 2 were given",
            "self-parameter",
            "def turn",
            "turn is a method, so its first parameter must be self.",
        ),
        (
            "outside() takes 0 positional arguments but 1 was given",
            "callback-parameters",
            "def outside",
            "outside is called with an argument but has",
        ),
        (
            "RcutilsLogger.info() takes 2 positional arguments but 4 were given",
            "log-arguments",
            "",
            "info takes one string,",
        ),
        (
            "Node.create_timer() takes from 3 to 6 positional arguments but 7 were given",
            "too-many-arguments",
            "",
            "Pass only the period and the callback to create_timer.",
        ),
        ("fill() takes 0 positional arguments but 1 was given", "crash", "", ""),
        (
            "Node.create_timer() got an unexpected keyword argument 'period'",
            "unexpected-keyword",
            "",
            "create_timer has no parameter period. Pass the period and the callback.",
        ),
        (
            "fill() got an unexpected keyword argument 'colour'",
            "unexpected-keyword",
            "",
            "fill has no parameter colour.",
        ),
        (
            "Expected <class 'geometry_msgs.msg._twist.Twist'>, got <class 'float'>",
            "publish-other",
            "",
            "This publisher sends Twist messages, but publish was called with an object of type float.",
        ),
        (
            "Expected <class 'geometry_msgs.msg._twist.Twist'>, got <class 'geometry_msgs.msg._twist.Metaclass_Twist'>",
            "class-for-object",
            "",
            "Twist is a class.",
        ),
        ("'int' object is not callable", "not-callable", "", "A value of type int is called"),
        ('can only concatenate str (not "int") to str', "string-and-number", "", "A string and a number"),
        (
            "rclpy_logging_rcutils_log(): incompatible function arguments.",
            "string-and-number",
            "",
            "A log method takes a string. Use an f-string to put a number into a string.",
        ),
        ("Expected QoSProfile or int, but received <class 'str'>", "queue-size", "", f"{QUEUE} without quotation"),
        ("Expected QoSProfile or int, but received <class 'float'>", "queue-size", "", f"{QUEUE}."),
        (
            "'property' object is not iterable",
            "class-for-object",
            "",
            "A class is used as a node. Add parentheses after the class name",
        ),
        ("what nobody has seen", "crash", "", ""),
    ],
)
def test_pythons_words_are_explained(error: str, diagnosis: str, look: str, words: str) -> None:
    source = NODE.format(line="self.drive()") + "\ndef outside():\n    pass\n"
    lines = [number for number, line in enumerate(source.splitlines(), 1) if look and look in line]
    found = reported(source, f"TypeError: {error}")
    assert (found.diagnosis, found.line) == (diagnosis, lines[0] if lines else to_look_at(source))
    assert found.cause.startswith(words)
    if diagnosis == "unexpected-keyword":
        assert found.cause == words


def test_what_was_spun_is_named() -> None:
    found = reported("rclpy.spin(Driver)  # crashed\n", "TypeError: 'property' object is not iterable")
    assert (found.diagnosis, "was called with Driver, which" in found.cause) == ("class-for-object", True)
    assert (
        "A class is used as a node."
        in reported("rclpy.spin()  # crashed\n", "TypeError: 'property' object is not iterable").cause
    )


def test_a_value_that_hides_a_method_is_found() -> None:
    found = reported(HIDES, "TypeError: 'int' object is not callable")
    assert (found.diagnosis, found.line) == ("name-used-twice", to_look_at(HIDES))
    assert found.cause == "self.send is assigned on line 4, which hides the method of the same name."


@pytest.mark.parametrize(
    ("made", "kind", "diagnosis"),
    [
        ("self.create_timer(0.5, self.send())", "NoneType", "callback-called"),
        ('self.create_service(Spawn, "/spawn", self.take())', "NoneType", "callback-called"),
        ("self.node.create_timer(0.5, self.send())", "NoneType", "callback-called"),
        ("self.create_timer(0.5, self.send())", "int", "not-callable"),
        ("self.create_timer(0.5, partial(self.send, 1))", "NoneType", "not-callable"),
        ("self.create_timer(0.5, self.send)", "NoneType", "not-callable"),
        ("self.create_timer(0.5)", "NoneType", "not-callable"),
        ("make()(0.5, self.send())", "NoneType", "not-callable"),
    ],
)
def test_nothing_is_called_where_a_callback_was_called(made: str, kind: str, diagnosis: str) -> None:
    source = f"class Driver(Node):\n    def __init__(self):\n        {made}\n\nrclpy.spin(node)  # crashed\n"
    found = reported(source, f"TypeError: '{kind}' object is not callable")
    assert (found.diagnosis, found.line) == (diagnosis, 3 if diagnosis == "callback-called" else 5)


def test_a_second_init_is_reported_with_all_its_lines() -> None:
    once, error = "rclpy.init()  # crashed\n", "RuntimeError: Context.init() must only be called once"
    assert reported(once, error).cause == "Call rclpy.init only once."
    found = reported(f"rclpy.init()\nrclpy.spin(node)\n{once}", error)
    assert found.diagnosis == "init-twice"
    assert found.cause.endswith(" rclpy.init is called on lines 1 and 3.")


NOT_CALLABLE = "RuntimeError: callback should be either be callable with one argument or two"


@pytest.mark.parametrize(
    ("line", "error", "diagnosis", "look"),
    [
        ("self.go()", "RCLError: create_publisher() called for existing topic name rt/x", "second-type", "crashed"),
        ("self.go()", "RuntimeError: timer period must be non-negative", "timer-period-negative", "crashed"),
        ("self.go()", "RuntimeError: something else", "crash", "crashed"),
        ('self.create_subscription(Pose, "/pose", self.take(), 10)', NOT_CALLABLE, "callback-called", "crashed"),
        ('self.create_subscription(Pose, "/pose", self.send, 10)', NOT_CALLABLE, "callback-parameters", "def send"),
        (
            'self.create_subscription(Pose, "/pose", self.driver.send, 10)',
            NOT_CALLABLE,
            "callback-parameters",
            "def send",
        ),
        (
            'self.create_subscription(Pose, "/pose", self.send, qos_profile=10)',
            NOT_CALLABLE,
            "callback-parameters",
            "def send",
        ),
        ('self.create_subscription(Pose, "/pose", self.take, 10)', NOT_CALLABLE, "not-callable", "crashed"),
        ('self.create_subscription(Pose, "/pose", callback=self.send)', NOT_CALLABLE, "not-callable", "crashed"),
        ('self.create_subscription(Pose, "/pose", make(), 10)', NOT_CALLABLE, "not-callable", "crashed"),
    ],
)
def test_what_rclpy_refuses_is_explained(line: str, error: str, diagnosis: str, look: str) -> None:
    source = NODE.format(line=line)
    lines = [number for number, text in enumerate(source.splitlines(), 1) if look in text]
    found = reported(source, error)
    assert (found.diagnosis, found.line) == (diagnosis, lines[0])
    assert found.cause != "" or diagnosis == "crash"
