"""The reasons why Python refuses an operator between two values."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, reported

LISTS = "A list is not an array: Python cannot compute with a whole list."
STRINGS = "A string and a number cannot be added."
OTHERS = "This operator cannot combine a value of type {} with a value of type {}."


@pytest.mark.parametrize(
    ("error", "diagnosis", "cause"),
    [
        ("unsupported operand type(s) for -: 'list' and 'float'", "list-for-array", LISTS),
        ("unsupported operand type(s) for /: 'int' and 'list'", "list-for-array", LISTS),
        ('can only concatenate list (not "float") to list', "list-for-array", LISTS),
        ('can only concatenate str (not "float") to str', "string-and-number", STRINGS),
        ("unsupported operand type(s) for +: 'int' and 'str'", "string-and-number", STRINGS),
        ("unsupported operand type(s) for +=: 'float' and 'str'", "string-and-number", STRINGS),
        ("unsupported operand type(s) for /: 'str' and 'float'", "crash", OTHERS.format("str", "float")),
        ("unsupported operand type(s) for -: 'list' and 'list'", "crash", OTHERS.format("list", "list")),
        ("unsupported operand type(s) for +: 'Twist' and 'float'", "crash", OTHERS.format("Twist", "float")),
    ],
)
def test_the_types_of_both_values_decide(error: str, diagnosis: str, cause: str) -> None:
    told = reported(DRIVER.format(line="both = self.count - step"), f"TypeError: {error}")
    assert told.diagnosis == diagnosis
    assert told.cause.startswith(cause)
    assert [text for text in (LISTS, STRINGS) if text != cause and text in told.cause] == []


@pytest.mark.parametrize(
    ("line", "diagnosis"),
    [
        ("both = max(step - self,count)", "comma-for-dot"),
        ("both = max(step - self, count)", "crash"),
        ("both = max(step - self.count, 1)", "crash"),
    ],
)
def test_a_comma_for_a_dot_makes_an_object_the_side_of_an_operator(line: str, diagnosis: str) -> None:
    told = reported(DRIVER.format(line=line), "TypeError: unsupported operand type(s) for -: 'float' and 'Driver'")
    assert told.diagnosis == diagnosis
    assert ("A comma separates self from count. Write a dot: self.count." in told.cause) == (diagnosis != "crash")


@pytest.mark.parametrize(
    ("error", "diagnosis"),
    [
        ("TypeError: unsupported operand type(s) for /: 'float' and 'Parameter'", "parameter-itself"),
        ("TypeError: unsupported operand type(s) for /: 'float' and 'Driver'", "crash"),
    ],
)
def test_a_parameter_beside_an_operator_lacks_its_value(error: str, diagnosis: str) -> None:
    line = 'turn = 1.0 / self.get_parameter("radius")'
    assert reported(DRIVER.format(line=line), error).diagnosis == diagnosis
