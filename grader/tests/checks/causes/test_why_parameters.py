"""A callback with too many or too few parameters: what the caller passes to it."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, reported

SOURCE = DRIVER.replace("\ndef outside", "\n    def changed(self):\n        pass\n\ndef outside")
ERROR = "TypeError: Driver.changed() takes 1 positional argument but 2 were given"
LINES = (
    "self.add_on_set_parameters_callback(self.changed)",
    "self.create_service(SetBool, '/a', self.changed)",
    "self.create_subscription(Pose, '/a', self.changed, 10)",
    "future.add_done_callback(self.changed)",
)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (
            "self.add_on_set_parameters_callback(self.changed)",
            "The callback for parameters gets the list of new parameters.",
        ),
        (
            "self.create_service(SetBool, '/a', self.changed)",
            "A service passes the request and the response to its callback.",
        ),
        (
            "self.create_subscription(Pose, '/a', self.changed, 10)",
            "A subscription passes the message to its callback.",
        ),
        ("future.add_done_callback(self.changed)", "A future passes itself to its callback."),
    ],
)
def test_each_caller_passes_something_else(line: str, words: str) -> None:
    said = {other: reported(SOURCE.format(line=other), ERROR).cause for other in LINES}
    assert said[line] == f"changed is called with an argument but has no parameter for it. {words}"
    assert not any(words in said[other] for other in LINES if other != line)


@pytest.mark.parametrize(("decorator", "found"), [("", True), ("@staticmethod", False), ("@classmethod", False)])
def test_a_static_method_needs_no_self(decorator: str, *, found: bool) -> None:
    source = f"class Driver(Node):\n    {decorator}\n    def send():\n        pass\n\nnode.spin()  # crashed\n"
    given = reported(source, "TypeError: Driver.send() takes 0 positional arguments but 1 was given")
    assert (given.cause == "send is a method, so its first parameter must be self.") == found


@pytest.mark.parametrize(("line", "found"), [("node = Driver()", True), ("node = make()", False)])
def test_an_object_without_its_arguments_is_reported_where_it_is_created(line: str, *, found: bool) -> None:
    source = (
        f"class Driver(Node):\n    def __init__(self, name):\n        super().__init__(name)\n\n{line}  # crashed\n"
    )
    given = reported(source, "TypeError: Driver.__init__() missing 1 required positional argument: 'name'")
    assert given.diagnosis == ("argument-missing" if found else "callback-parameters")
    assert (given.cause == "An object of Driver is created here without a value for 'name'.") == found


@pytest.mark.parametrize(("line", "found"), [("Driver.changed()", True), ("self.changed()", False)])
def test_a_method_that_is_called_on_the_class_is_told(line: str, *, found: bool) -> None:
    error = "TypeError: Driver.changed() missing 1 required positional argument: 'self'"
    given = reported(SOURCE.format(line=line), error)
    words = "This line calls changed on the class Driver, not on an object. Add parentheses after the class name to"
    assert given.cause.startswith(words) == found
    assert (given.diagnosis == "class-for-object") == found


def test_an_object_with_too_many_arguments_has_nothing_to_do_with_timers() -> None:
    error = "TypeError: Driver.__init__() takes 1 positional argument but 2 were given"
    given = reported(SOURCE.format(line="Driver('a')"), error)
    assert given.cause == "__init__ is called with an argument but has no parameter for it."
