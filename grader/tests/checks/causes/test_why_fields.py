"""Why a message's field refused a value."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import told

FLOAT = "AssertionError: The 'x' field must be of type 'float'"


@pytest.mark.parametrize(
    ("line", "diagnosis", "words"),
    [
        ("msg.linear.x = 2", "int-for-float", "write the number with a decimal point."),
        ("msg.linear.x = -2", "int-for-float", "write the number with a decimal point."),
        ("msg.linear = Vector3(y=2.0, x=2)", "int-for-float", "write the number with a decimal point."),
        ("msg.linear.y = msg.linear.x = 2", "int-for-float", "write the number with a decimal point."),
        ("msg.linear.x = SPEED", "int-for-float", "write the number with a decimal point."),
        ("msg.linear.x = round(speed)", "int-for-float", "round(...) gives a whole number."),
        ('msg.linear.x = "2.0"', "text-for-number", "in quotation marks it is a text."),
        ("msg.linear.x = input()", "text-for-number", "what is read is a text."),
        ('msg.linear.x = os.environ.get("SPEED")', "text-for-number", "what is read is a text."),
        ("msg.linear.x = np.float32(2)", "numpy-for-float", "numpy has others."),
        ("msg.linear.x = 2 * numpy.sqrt(2)", "numpy-for-float", "numpy has others."),
        ("msg.linear.x = True", "field-type", "neither true nor false."),
        ("msg.linear.x = look_up()()", "field-type", "the value is of another type."),
        ("msg.linear.x = speed", "field-type", "the value is of another type."),
        ("msg.linear.y = 2", "field-type", "the value is of another type."),
        ("move(msg)", "field-type", "the value is of another type."),
    ],
)
def test_the_value_tells_why_it_is_no_float(line: str, diagnosis: str, words: str) -> None:
    found = told(f"SPEED = 2\n{line}  # crashed\n", FLOAT)
    assert (found.diagnosis, found.line) == (diagnosis, 2)
    assert found.cause.startswith("The field x ")
    assert (
        found.cause.removesuffix(" float(...) makes one of it.").removesuffix(" float(...) makes one.").endswith(words)
    )


def test_a_value_of_which_nothing_is_known_is_of_another_type() -> None:
    assert told("", FLOAT).diagnosis == "field-type"


@pytest.mark.parametrize(
    ("error", "diagnosis", "words"),
    [
        ("The 'x' field must be of type 'double'", "int-for-float", "The field x is a float:"),
        (
            "The 'linear' field must be a sub message of type 'Vector3'",
            "field-type",
            "The field linear is itself a Vector3,",
        ),
        ("Invalid arguments passed to constructor: x", "message-arguments", "A message is made empty,"),
        ("it did not hold", "crash", "Something that the code"),
    ],
)
def test_an_assertion_is_explained_by_its_words(error: str, diagnosis: str, words: str) -> None:
    found = told("msg.linear.x = 2  # crashed\n", f"AssertionError: {error}")
    assert (found.diagnosis, found.line) == (diagnosis, 1)
    assert found.cause.startswith(words)
