"""A fitted circle that is wrong, an exception or the end of the program is reported with its cause."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from grader.checks.subjects.fit import FITS
from grader.evidence.evidence import Evidence, Run
from grader.tests.checks.bag_step import EXERCISE, IMPORT, RADIUS, X, Y, judged, raised, returned, solution
from grader.tests.checks.made import found
from grader.tests.checks.told import told
from grader.trial.called import TOO_LATE, Called

C = RADIUS**2 - X**2 - Y**2


@pytest.mark.parametrize(
    ("called", "diagnosis"),
    [
        (returned(X, Y, RADIUS), None),
        (returned(Y, X, RADIUS), "x-y-swapped"),
        (returned(RADIUS, X, Y), "result-order"),
        (returned(X, Y, RADIUS**2), "radius-squared"),
        (returned(X, Y, 2 * RADIUS), "diameter"),
        (returned(X, Y, C), "radius-without-centre"),
        (returned(X, Y, math.sqrt(-C)), "radius-without-centre"),
        (returned(X, Y, math.nan), "radius-without-centre"),
        (returned(math.nan, Y, RADIUS), "not-a-number"),
        (returned(2 * X, 2 * Y, 9.0), "centre-doubled"),
        (returned(-X, -Y, RADIUS), "centre-sign"),
        (returned(0.0, 0.0, 0.0), "wrong-fit"),
        (returned(X, Y, RADIUS + 0.01), "wrong-fit"),
        (returned(X, Y), "result-form"),
        (Called("whole", "exit 0", kind="NoneType"), "result-form"),
        (Called("whole", TOO_LATE), "call-too-long"),
        (Called("whole", "exit 1", stderr="the end\n"), "call-ended"),
        (Called("whole"), "call-ended"),
        (raised("whole", "ValueError: too many values to unpack (expected 3)"), "lstsq-result"),
        (raised("whole", "ZeroDivisionError: division by zero"), "crash"),
    ],
)
def test_what_a_fit_returned_has_a_cause(called: Called, diagnosis: str | None) -> None:
    assert judged("whole", called).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("values", "diagnosis"),
    [
        ((6.430, 6.440, 1.538), "mean-for-centre"),
        ((6.263, 6.017, 2.555), "extremes-for-centre"),
        ((6.001, 4.002, 2.998), None),
    ],
)
def test_an_arc_shows_what_is_taken_for_its_centre(values: tuple[float, ...], diagnosis: str | None) -> None:
    source = {"my_robot_controller/circle_fit.py": b"a = (min(x) + max(x)) / 2\n"}
    assert judged("arc", replace(returned(*values), id="arc"), source).diagnosis == diagnosis


RIGHT = returned(X, Y, RADIUS)
TOO_MANY = raised("whole", "ValueError: too many values to unpack (expected 3)")


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("fit_circle returned x=5.500, y=7.250 and radius=1.750.", RIGHT, returned(X, Y)),
        (
            "fit_circle returns x=5.5, y=7.25 and radius=1.75 (m) for 100 points from 0° to 356.4°.",
            returned(X, Y),
            RIGHT,
        ),
        ("fit_circle returned 2 numbers (5.5 and 7.25).", returned(X, Y), RIGHT),
        ("fit_circle returned no numbers.", returned(), returned(X, Y)),
        ("fit_circle must return three numbers: `return x, y, radius`.", returned(X, Y), returned(Y, X, RADIUS)),
        ("In numpy, the square root of a negative number", returned(math.nan, Y, RADIUS), returned(X, Y, math.nan)),
        ("fit_circle did not end in time", Called("whole", TOO_LATE), Called("whole", "signal 9")),
        ("A loop may never end, or the code may wait", Called("whole", TOO_LATE), Called("whole", "signal 9")),
        ("fit_circle ended the program (exit 1: the end).", Called("whole", "exit 1", stderr="the end\n"), TOO_MANY),
        ("fit_circle ended the program (no result).", Called("whole"), Called("whole", "exit 1")),
        (
            "fit_circle raised ZeroDivisionError: division by zero.",
            raised("whole", "ZeroDivisionError: division by zero"),
            raised("whole", "ZeroDivisionError: float division by zero"),
        ),
        (
            "The import of fit_circle raised ZeroDivisionError: division by zero.",
            Called("whole", "exit 1", stderr=f"{IMPORT}ZeroDivisionError: division by zero"),
            raised("whole", "ZeroDivisionError: division by zero"),
        ),
        (
            "lstsq takes the matrix first and the right-hand side second. lstsq returns four values",
            TOO_MANY,
            raised("whole", "ZeroDivisionError: division by zero"),
        ),
    ],
)
def test_a_sentence_about_a_fit_is_true(words: str, true: Called, near: Called) -> None:
    assert words in told(judged("whole", true))
    assert words not in told(judged("whole", near))


NO_LISTS = "The function works with numpy arrays, but not with lists. `np.asarray` accepts arrays and lists."


@pytest.mark.parametrize(
    ("others", "check", "is_told"),
    [
        ((RIGHT,), "lists", True),
        ((), "lists", False),
        ((RIGHT,), "elsewhere", False),
        ((Called("straight", "exit 0", values=(3.0, 3.0, 2.0), kind="tuple"),), "lists", False),
    ],
)
def test_lists_are_refused_only_if_arrays_are_not(others: tuple[Called, ...], check: str, *, is_told: bool) -> None:
    error = raised(check, "TypeError: can't multiply sequence by non-int of type 'float'")
    given = told(judged(check, error, others=others))
    assert (NO_LISTS in given) == is_told


@pytest.mark.parametrize(("ended", "is_told"), [(TOO_LATE, True), ("signal 9", False)])
def test_a_call_after_one_that_did_not_end_was_not_made(ended: str, *, is_told: bool) -> None:
    given = told(judged("noise", Called("noise"), others=(Called("whole", ended),)))
    words = "fit_circle was not called with this input, because an earlier call did not end."
    assert (words in given) == is_told


def test_only_the_points_of_an_arc_have_a_circle() -> None:
    run = Run(called=(Called("too-few", "exit 0"), RIGHT))
    given = Evidence(EXERCISE, solution(), runs={"fit": run}).from_trial("fit")
    with pytest.raises(ValueError, match="the points too-few are not points of an arc"):
        found(FITS, given, call="too-few")
    assert found(FITS, given, call="whole").diagnosis is None


FILE = "my_robot_controller/circle_fit.py"
SHAPE = "numpy.linalg.LinAlgError: Incompatible dimensions"
UNPACK = "ValueError: not enough values to unpack (expected 3, got {})"


def source(stack: str = "asarray", solver: str = "lstsq", line: str = "pass") -> dict[str, bytes]:
    """Return a module whose line 9 is the given line, at which the made-up exceptions are raised."""
    code = f"import numpy as np\n\n\ndef fit_circle(x, y):\n    a = np.{stack}(x)\n    np.linalg.{solver}(a, y)\n\n\n"
    return {FILE: f"{code}    {line}\n".encode()}


@pytest.mark.parametrize(
    ("true", "near", "errors", "words"),
    [
        (
            source("vstack"),
            source("column_stack"),
            (SHAPE, SHAPE),
            "vstack puts the arrays below each other. The matrix needs one row for each point, with three columns.",
        ),
        (
            source("array"),
            source("asarray"),
            ("TypeError: Cannot construct a dtype from an array", "TypeError: no dtype"),
            "The second argument of np.array is the type of the elements. Call np.array once for each list.",
        ),
        (
            source(),
            source(),
            (UNPACK.format(2), UNPACK.format(1)),
            "lstsq returns one value for each column of the matrix. Three unknowns need three columns.",
        ),
        (
            source(solver="solve"),
            source(),
            (SHAPE, SHAPE),
            "solve needs exactly as many equations as unknowns. lstsq accepts more equations, one for each point.",
        ),
        (
            source(line="raise ValueError('a line')"),
            source(line="int('a line')"),
            ("ValueError: a line", "ValueError: a line"),
            "Your own code raises this error for these points, although they form a circle.",
        ),
    ],
)
def test_the_source_and_the_exception_show_the_cause(
    true: dict[str, bytes], near: dict[str, bytes], errors: tuple[str, str], words: str
) -> None:
    assert words in told(judged("whole", raised("whole", errors[0]), true))
    assert words not in told(judged("whole", raised("whole", errors[1]), near))


def test_a_raise_of_the_student_is_blamed_before_lists() -> None:
    error = raised("lists", "ValueError: a circle needs four points")
    code = source(line="raise ValueError('a circle needs four points')")
    assert judged("lists", error, code, others=(RIGHT,)).diagnosis == "refuses-circle"
    assert judged("lists", error, source(line="int('x')"), others=(RIGHT,)).diagnosis == "lists-refused"


@pytest.mark.parametrize(
    ("error", "check", "told"),
    [
        ("TypeError: fit_circle() takes 1 positional argument but 2 were given", "whole", True),
        ("TypeError: fit_circle() takes 1 positional argument but 2 were given", "too-few", True),
        ("TypeError: fit_circle() missing 1 required positional argument: 'z'", "whole", True),
        ("TypeError: helper() takes 1 positional argument but 2 were given", "whole", False),
        ("TypeError: unsupported operand", "too-few", False),
    ],
)
def test_a_function_with_other_parameters_is_told(error: str, check: str, *, told: bool) -> None:
    finding = judged(check, Called(check, "exit 1", stderr=error, kind="TypeError Exception"))
    assert ("fit_circle is called with two arguments: the x of all points, and the y" in finding.cause) == told
    assert told == (finding.diagnosis in ("argument-missing", "too-many-arguments"))
    assert told == ("raised TypeError: fit_circle()" in finding.observed)


@pytest.mark.parametrize(
    ("exact", "check", "words"),
    [
        (RIGHT, "noise", "The circle of exact points is right, but these points have noise. Use all points"),
        (returned(X, Y, 9.0), "noise", "The function computes a circle that does not fit the points."),
        (RIGHT, "lists", "The function computes a circle that does not fit the points."),
    ],
)
def test_a_function_that_fits_only_exact_points_is_told(exact: Called, check: str, words: str) -> None:
    wrong = Called(check, "exit 0", values=(1.2, 3.4, 0.7), kind="tuple")
    lists = Called("lists", "exit 0", values=(1.2, 3.4, 0.7), kind="tuple")
    others = (exact, lists) if check == "noise" else (exact,)
    finding = judged(check, wrong, others=others)
    assert (finding.cause.startswith(words), finding.diagnosis) == (True, "wrong-fit")
    assert ("exact points" not in finding.cause) == ("exact points" not in words)
