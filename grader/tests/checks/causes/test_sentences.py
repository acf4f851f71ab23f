"""Each sentence about an exception is printed where it is true, and not for a similar line with the same exception."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, reported, to_look_at

NO_NAME = "NameError: name '{}' is not defined"
NO_ATTRIBUTE = "AttributeError: {} has no attribute '{}'"
TOO_FEW = "TypeError: Driver.{}() missing 1 required positional argument: '{}'"
TOO_MANY = "TypeError: Driver.{}() takes {} positional argument{} but {} were given"
METHODS = """
    def drive(self, step):
        print(step)

    def turn(self, step):
        pass

    def stop(self):
        pass
"""
SOURCE = "import rclpy\n" + DRIVER.replace("\ndef outside", METHODS + "\ndef outside")


def cause(line: str, error: str) -> str:
    """Return the cause for a node that crashes in this line."""
    return reported(SOURCE.format(line=line), error).cause


@pytest.mark.parametrize(
    ("words", "true", "near", "error"),
    [
        ("has no item with this index", "x = [1][1]", None, "IndexError: list index out of range"),
        ("A number is too large for this operation.", "x = 2.0 ** 9999", None, "OverflowError: out of range"),
        ("A function calls itself again and again,", "self.send()", None, "RecursionError: maximum recursion depth"),
        ("A node name has only letters, digits", "x = 1", None, "InvalidNodeNameException: Invalid node name"),
        ("ROS 2 was used before rclpy.init or after", "rclpy.init()", None, "NotInitializedException: no context"),
        (
            "belongs to rospy, the Python library of ROS 1",
            "rclpy.loginfo('a')",
            None,
            NO_ATTRIBUTE.format("module 'rclpy'", "loginfo"),
        ),
        (
            "Separate two arguments with a comma, not with a dot.",
            "self.create_timer(0.5. self, self.send)",
            None,
            NO_ATTRIBUTE.format("'float' object", "self"),
        ),
        (
            "Here create_publisher expects a string",
            "self.create_publisher(Twist, topic, 10)",
            "self.create_publisher(topic, '/a', 10)",
            NO_NAME.format("topic"),
        ),
        (
            "A similar name exists: node. Upper and lower case matter.",
            "node = self; rclpy.spin(Node)",
            "Node = self; rclpy.spin(Node)",
            NO_NAME.format("Node"),
        ),
        (
            "A similar name exists: node.",
            "node = self; rclpy.spin(Node)",
            "node = self; Node()",
            NO_NAME.format("Node"),
        ),
        ("This is a future.", "x = answer.name", None, NO_ATTRIBUTE.format("'Future' object", "name")),
        ("use the name this for the object", "this.count = 1", None, NO_NAME.format("this")),
        ("A method can use self only if", "self.count = 1", None, NO_NAME.format("self")),
        (
            "is called here without a value for 'step'.",
            "self.drive()",
            "self.create_timer(1.0, self.drive)",
            TOO_FEW.format("drive", "step"),
        ),
        (
            "turn does not use its parameter 'step', and the call on line 10 passes no value for it.",
            "self.turn()",
            "self.drive()",
            TOO_FEW.format("turn", "step"),
        ),
        (
            "turn does not use its parameters 'step' and 'more', and the call on line 10 passes no value for them.",
            "self.turn()",
            "self.drive()",
            TOO_FEW.format("turn", "step' and 'more"),
        ),
        (
            "drive is called immediately. To pass the method itself",
            "other(self.drive())",
            "x = self.drive()",
            TOO_FEW.format("drive", "step"),
        ),
        (
            "A timer calls its callback without arguments.",
            "self.create_timer(1.0, self.drive)",
            "self.create_subscription(Pose, '/a', self.drive, 10)",
            TOO_FEW.format("drive", "step"),
        ),
        (
            "A subscription passes the message to its callback.",
            "self.create_subscription(Pose, '/a', self.stop, 10)",
            "self.create_timer(1.0, self.stop)",
            TOO_MANY.format("stop", 1, "", 2),
        ),
        (
            "A future passes itself to its callback.",
            "future.add_done_callback(self.stop)",
            "self.create_timer(1.0, self.stop)",
            TOO_MANY.format("stop", 1, "", 2),
        ),
        (
            "a timer passes no argument, a subscription passes the message, and a future passes itself".capitalize(),
            "other(self.stop)",
            "self.create_timer(1.0, self.stop)",
            TOO_MANY.format("stop", 1, "", 2),
        ),
        (
            "super is a function. Write super().__init__",
            "super.__init__('a')",
            None,
            "TypeError: descriptor '__init__' requires a 'super' object but received a 'str'",
        ),
        (
            "This call to shutdown ends ROS 2",
            "rclpy.shutdown()\n        rclpy.spin(self)",
            "rclpy.spin(self)  # crashed\n        rclpy.shutdown()",
            "TypeError: 'NoneType' object does not support the context manager protocol",
        ),
        (
            "min or max got no values to compare",
            "x = max([])",
            None,
            "ValueError: max() arg is an empty sequence",
        ),
        (
            "An object of Driver can be called only if",
            "self()",
            None,
            "TypeError: 'Driver' object is not callable",
        ),
        (
            "self.other is None here",
            "self.other.x",
            "self.other.x + self.another.x",
            NO_ATTRIBUTE.format("'NoneType' object", "x"),
        ),
        (
            "You can create objects only of the parts",
            "x = Spawn()",
            None,
            "NotImplementedError: Service classes can not be instantiated",
        ),
        (
            "rclpy puts the feedback into another message",
            "x = msg.remaining",
            None,
            NO_ATTRIBUTE.format("'RotateAbsolute_FeedbackMessage' object", "remaining"),
        ),
        (
            "tkinter is Python's module for graphical windows",
            "import tkinter",
            None,
            "ModuleNotFoundError: No module named 'tkinter'",
        ),
        (
            "example_interfaces is a package of ROS 2",
            "import example_interfaces",
            None,
            "ModuleNotFoundError: No module named 'example_interfaces'",
        ),
    ],
)
def test_a_sentence_is_printed_where_it_is_true_and_not_near_it(
    words: str, true: str, near: str | None, error: str
) -> None:
    assert words in cause(true, error)
    assert words not in cause(near or true, error if near else "ZeroDivisionError: division by zero")


INSIDE = "\n    def publish_it(self):\n        pass\n"
OUTSIDE = "\ndef publish_it(self):\n    pass\n"


@pytest.mark.parametrize(("methods", "found"), [(OUTSIDE, True), (INSIDE, False)])
def test_a_class_that_ends_too_early_is_told(methods: str, *, found: bool) -> None:
    source = DRIVER.format(line="Driver.other()").replace("\ndef outside", f"{methods}\ndef outside")
    given = reported(source, NO_ATTRIBUTE.format("type object 'Driver'", "other")).cause
    words = "publish_it is not indented, so the class ends above it. Indent publish_it like the other methods."
    assert (given == words) == found


@pytest.mark.parametrize(("line", "found"), [("self.other.x", True), ("self.other.x + self.another.x", False)])
def test_what_is_none_is_told_only_if_it_is_clear(line: str, *, found: bool) -> None:
    given = cause(line, NO_ATTRIBUTE.format("'NoneType' object", "x"))
    assert given.startswith("self.other is None here, so it has" if found else "The value is None here, so it has")


@pytest.mark.parametrize(("made", "found"), [("    node = Driver()\n", True), ("    return Driver()\n", False)])
def test_a_function_without_return_that_creates_the_node_is_told(made: str, *, found: bool) -> None:
    source = f"{SOURCE.format(line='pass').replace('# crashed', '')}\ndef make():\n{made}\nnode = make()\n"
    source += "rclpy.spin(node)  # crashed\n"
    given = reported(source, NO_ATTRIBUTE.format("'NoneType' object", "executor")).cause
    assert given.startswith("rclpy.spin was called with None instead of a node.")
    assert ("make has no return statement with a value, so it returns None." in given) == found


@pytest.mark.parametrize(
    ("files", "words"),
    [
        ({"my_robot_controller/speeds.py": ""}, "my_robot_controller/speeds.py exists, but you must import it"),
        ({"speeds.py": ""}, "speeds.py is next to setup.py, so it is not installed."),
        ({}, "No installed package has a module speeds."),
    ],
)
def test_where_a_module_is_decides_what_is_told(files: dict[str, str], words: str) -> None:
    given = reported(SOURCE.format(line="import speeds"), "ModuleNotFoundError: No module named 'speeds'", files)
    assert words in given.cause
    assert given.cause.count(" exists, but you must import it with") == words.count(" exists, but")


@pytest.mark.parametrize(("name", "found"), [("count", True), ("another", False)])
def test_a_class_in_place_of_an_object_is_told(name: str, *, found: bool) -> None:
    given = cause(f"Driver.{name}", NO_ATTRIBUTE.format("type object 'Driver'", name))
    assert (given == "Driver is a class. Add parentheses after the class name to create an object.") == found


@pytest.mark.parametrize(("body", "found"), [("step.x = 1", True), ("return step", False)])
def test_a_function_without_return_whose_value_is_published_is_told(body: str, *, found: bool) -> None:
    source = (
        f"{SOURCE.format(line='self.p.publish(make(1))')}\ndef make(step):{'  # look' if found else ''}\n    {body}\n"
    )
    error = "TypeError: Expected <class 'geometry_msgs.msg._twist.Twist'>, got <class 'NoneType'>"
    given = reported(source, error)
    assert given.line == to_look_at(source)
    assert "This publisher sends Twist messages, but publish was called with None." in given.cause
    assert ("make has no return statement with a value, so it returns None." in given.cause) == found


@pytest.mark.parametrize(("callback", "found"), [("Driver.stop", True), ("self.stop", False)])
def test_a_method_without_its_object_is_told(callback: str, *, found: bool) -> None:
    source = SOURCE.format(line="pass") + f"\nnode.create_timer(1.0, {callback})\n"
    given = reported(source, TOO_FEW.format("stop", "self")).cause
    words = "Driver.stop does not belong to an object. Pass the method of an object, as in self.stop."
    assert (given == words) == found


@pytest.mark.parametrize(("set_there", "found"), [("self.other = 1", True), ("self.pub = 1", False)])
def test_an_attribute_that_a_base_class_misses_is_told(set_there: str, *, found: bool) -> None:
    source = "from my_robot_controller.circle import Circle\n" + SOURCE.format(line="self.pub.publish()")
    circle = f"class Circle(Driver):\n    def start(self):\n        {set_there}\n"
    given = reported(source, NO_ATTRIBUTE.format("'Circle' object", "pub"), {"my_robot_controller/circle.py": circle})
    assert (given.cause == "self.pub is never assigned, and the class has no method with that name.") == found


@pytest.mark.parametrize(
    ("line", "found"), [("self.create_timer(1.0, self.send)", True), ("self._timer.cancel()", False)]
)
def test_an_attribute_of_rclpy_is_not_confused_with_the_students(line: str, *, found: bool) -> None:
    given = cause(line, NO_ATTRIBUTE.format("'Driver' object", "_default_callback_group" if found else "_timer"))
    assert ("super().__init__ creates the node." in given) == found
