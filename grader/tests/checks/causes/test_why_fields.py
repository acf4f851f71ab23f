"""The reasons why a message field rejected a value."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported

FLOAT = "AssertionError: The 'x' field must be of type 'float'"


@pytest.mark.parametrize(
    ("line", "diagnosis", "words"),
    [
        ("msg.linear.x = 2", "int-for-float", "but 2 is an integer. Write the number with a decimal point."),
        ("msg.linear.x = -2", "int-for-float", "but -2 is an integer. Write the number with a decimal point."),
        ("msg.linear = Vector3(y=2.0, x=2)", "int-for-float", "Write the number with a decimal point."),
        ("msg.linear.y = msg.linear.x = 2", "int-for-float", "Write the number with a decimal point."),
        ("msg.linear.x = SPEED", "int-for-float", "but 2 is an integer. Write the number with a decimal point."),
        ("msg.linear.x = round(speed)", "int-for-float", "round(...) returns an integer."),
        ('msg.linear.x = "2.0"', "string-for-number", "In quotation marks, a number is a string."),
        ("msg.linear.x = input()", "string-for-number", "but the value is a string."),
        ('msg.linear.x = os.environ.get("SPEED")', "string-for-number", "but the value is a string."),
        ('msg.linear.x = speeds.get("slow")', "field-type", "but the value has another type."),
        ("msg.linear.x = np.float32(2)", "numpy-for-float", "not a NumPy value."),
        ("msg.linear.x = 2 * numpy.sqrt(2)", "numpy-for-float", "not a NumPy value."),
        ("msg.linear.x = True", "field-type", "not True or False."),
        ("msg.linear.x = look_up()()", "field-type", "the value has another type."),
        ("msg.linear.x = speed", "field-type", "the value has another type."),
        ("msg.linear.y = 2", "field-type", "the value has another type."),
        ("move(msg)", "field-type", "the value has another type."),
    ],
)
def test_the_value_tells_why_it_is_no_float(line: str, diagnosis: str, words: str) -> None:
    found = reported(f"SPEED = 2\n{line}  # crashed\n", FLOAT)
    assert (found.diagnosis, found.line) == (diagnosis, 2)
    assert found.cause.startswith("The field x ")
    assert (
        found.cause.removesuffix(" Convert it with float(...).")
        .removesuffix(" Convert it with float(...).")
        .endswith(words)
    )


@pytest.mark.parametrize(
    ("line", "error", "cause"),
    [
        (
            "msg.linear = 2.0",
            "The 'linear' field must be a sub message of type 'Vector3'",
            "The field linear has the type Vector3, with its own fields. Set these fields.",
        ),
        ("msg.data = 2", "The 'data' field must be of type 'str'", "The value of the field data must be a string."),
        ("msg.data = 2.0", "The 'data' field must be of type 'str'", "The value of the field data must be a string."),
        (
            "msg.data = 1",
            "The 'data' field must be of type 'bool'",
            "The value of the field data must be True or False.",
        ),
        ("msg.data = b''", "The 'data' field must be of type 'bytes' or", "The value of the field data must be bytes."),
        (
            "pen.r = 2.0",
            "The 'r' field must be of type 'int'",
            "The value of the field r must be a whole number: write it without a decimal point.",
        ),
        ("pen.r = '2'", "The 'r' field must be of type 'int'", "The value of the field r must be a whole number."),
        (
            "pen.r = 300",
            "The 'r' field must be an unsigned integer in [0, 255]",
            "The field r is a whole number from 0 to 255.",
        ),
    ],
)
def test_a_field_that_is_no_float_has_its_own_sentence(line: str, error: str, cause: str) -> None:
    found = reported(f"{line}  # crashed\n", f"AssertionError: {error}")
    assert (found.diagnosis, found.line, found.cause) == ("field-type", 1, cause)
    assert reported(f"{line}  # crashed\n", FLOAT).cause != cause


def test_a_value_of_which_nothing_is_known_is_of_another_type() -> None:
    assert reported("", FLOAT).diagnosis == "field-type"


@pytest.mark.parametrize(
    ("error", "diagnosis", "words"),
    [
        ("The 'x' field must be of type 'double'", "int-for-float", "The field x is a float, but"),
        (
            "The 'linear' field must be a sub message of type 'Vector3'",
            "field-type",
            "The field linear has the type Vector3, with",
        ),
        ("Invalid arguments passed to constructor: x", "message-arguments", "Create the message without arguments,"),
        ("it did not hold", "crash", "An assertion failed: a condition was false"),
    ],
)
def test_an_assertion_is_explained_by_its_words(error: str, diagnosis: str, words: str) -> None:
    found = reported("msg.linear.x = 2  # crashed\n", f"AssertionError: {error}")
    assert (found.diagnosis, found.line) == (diagnosis, 1)
    assert found.cause.startswith(words)


@pytest.mark.parametrize(
    ("default", "read", "words"),
    [
        ("1", "speed", "the default value of the parameter speed is the integer 1. Write 1.0."),
        ("1", "radius", "the value has another type. Convert it with float(...)."),
        ("1.0", "speed", "the value has another type. Convert it with float(...)."),
        ("True", "speed", "the value has another type. Convert it with float(...)."),
    ],
)
def test_a_parameter_with_an_integer_as_its_default_value_is_named(default: str, read: str, words: str) -> None:
    source = f"""\
class Driver(Node):
    def __init__(self):
        self.declare_parameter("speed", {default})

    def send(self):
        speed = self.get_parameter("{read}").value
        msg.linear.x = speed  # crashed
"""
    found = reported(source, FLOAT)
    assert found.cause.endswith(words)
    assert found.line == (3 if "default value" in words else 7)


RANGE = (
    "AssertionError: The 'ranges' field must be a set or sequence with length <= 1 and each value of type "
    "'FloatingPointRange'"
)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("msg.ranges = [(0.2, 3.0)]", "Each element of the list ranges must be an object of the class FloatingPoint"),
        ("Parameter(  # crashed\n    ranges=[(0.2, 3.0)],\n)", "Each element of the list ranges must be an object"),
        ("msg.ranges = (0.2, 3.0)", "The field ranges is a list. Write square brackets, even for one element."),
    ],
)
def test_a_list_of_other_objects_has_its_brackets(line: str, words: str) -> None:
    cause = reported(line if "# crashed" in line else f"{line}  # crashed\n", RANGE).cause
    assert words in cause
    assert ("Each element" not in cause) == ("Each element" not in words)
