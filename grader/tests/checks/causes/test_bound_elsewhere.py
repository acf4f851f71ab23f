"""A NameError for a name that has a value elsewhere: in a global statement, in another function, or as a parameter."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported

NO_NAME = "NameError: name '{}' is not defined"
GLOBAL = "def a():\n    global pose\n    pose = 1\n\ndef b():\n    print(pose)  # crashed\n"
PARAMETER = "def a(msg):\n    print(msg)\n\ndef b():\n    print(msg)  # crashed\n"


def test_a_global_variable_is_not_called_a_local_one() -> None:
    found = reported(GLOBAL, NO_NAME.format("pose"))
    text = "pose gets its value on line 3, in a. That line has not run yet."
    assert (found.diagnosis, found.cause) == ("name-too-early", text)
    assert reported(GLOBAL.replace("    global pose\n", ""), NO_NAME.format("pose")).diagnosis == "local-name"


def test_a_parameter_of_another_function_is_named() -> None:
    found = reported(PARAMETER, NO_NAME.format("msg"))
    text = "msg is a parameter of a (line 1), and exists only in that function."
    assert (found.diagnosis, found.cause) == ("local-name", text)
    here = reported("def a(step):\n    print(msg)  # crashed\n", NO_NAME.format("msg"))
    assert here.cause.startswith("Nothing defines this name before this line.")


@pytest.mark.parametrize(("line", "found"), [("pass", True), ("global ticks", False)])
def test_a_global_counter_is_not_called_a_local_variable_of_init(line: str, *, found: bool) -> None:
    source = "class A:\n    def __init__(self):\n        {}\n        ticks = 0\n\n    def b(self):\n"
    source += "        ticks += 1  # crashed\n"
    error = "UnboundLocalError: cannot access local variable 'ticks' where it is not associated with a value"
    assert ("local variable of __init__" in reported(source.format(line), error).cause) == found


def test_a_function_outside_a_class_is_not_told_to_use_self() -> None:
    error = "UnboundLocalError: cannot access local variable 'n' where it is not associated with a value"
    given = reported("def count():\n    n += 1  # crashed\n", error).cause
    assert given == "A variable that a function assigns to is local to that function. Give n a value before this line."


@pytest.mark.parametrize(("stored", "found"), [("dist = 1.0", False), ("other = 1.0", True)])
def test_a_name_of_the_file_is_not_called_one_of_math(stored: str, *, found: bool) -> None:
    source = f"def a():\n    {stored}\n\ndef b():\n    print(dist)  # crashed\n"
    given = reported(source, NO_NAME.format("dist")).cause
    assert (given == "The file does not import dist, which is in the module math.") == found
    assert ("dist is a local variable of a (line 2)." in given) != found


@pytest.mark.parametrize(("begin", "found"), [("def main():", True), ("class A:\n  def send():", False)])
def test_a_function_outside_a_class_has_no_self(begin: str, *, found: bool) -> None:
    given = reported(f"{begin}\n    self.count = 1  # crashed\n", NO_NAME.format("self")).cause
    assert given.startswith("self exists only inside a method.") == found


@pytest.mark.parametrize(("line", "found"), [("n = 1", True), ("m = 1", False)])
def test_a_line_that_has_not_run_is_named_for_a_local_variable(line: str, *, found: bool) -> None:
    error = "UnboundLocalError: cannot access local variable 'n' where it is not associated with a value"
    source = f"def a(b):\n    if b:\n        {line}\n    print(n)  # crashed\n    n = 2\n"
    given = reported(source, error).cause
    assert (given == "Line 3 gives n a value, but that line has not run in this call.") == found
