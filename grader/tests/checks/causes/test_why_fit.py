"""A wrong circle is explained by the mistake that leads to these numbers."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_fit import Fit, uses_extremes, why_fit
from grader.common.lazy import np
from grader.exercise.call_inputs import Arc
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission

ARC = Arc(6.0, 4.0, 3.0, 20.0, 140.0, 300, 0.01)
X, Y, R = ARC.x_m, ARC.y_m, ARC.radius_m
WITHIN = (0.02, 0.02, 0.02)


def mean() -> tuple[float, float, float]:
    return X + R * float(np.cos(ARC.angles()).mean()), Y + R * float(np.sin(ARC.angles()).mean()), 2.0


def between_extremes() -> tuple[float, float, float]:
    x, y = X + R * np.cos(ARC.angles()), Y + R * np.sin(ARC.angles())
    return float(x.min() + x.max()) / 2, float(y.min() + y.max()) / 2, 2.0


OTHERWISE = (
    "The function computes a circle that does not fit the points. Test the function with four points of a circle that "
    "you know."
)
SENTENCES = (
    "The two coordinates of the centre are swapped.",
    "The three numbers are right, but their order is wrong. Return the x and y of the centre first, then the radius.",
    "You get this result if the right side of the equations is x + y instead of x² + y².",
    "This is the square of the radius. The equation of the circle contains r squared.",
    "This is the diameter, twice the radius.",
    "The third unknown is c = r² - a² - b², not r². To compute r², add a² + b² to c.",
    "A radius that is computed only from the outermost points contains all the noise of these points.",
    "The centre is twice as far away as it should be: the equation contains 2·x·a and 2·y·b.",
    "The centre has the wrong sign. Check on which side of the equation each term is.",
    "This is the mean of the points. The mean is the centre only if the points cover the whole circle.",
    "This is the midpoint between the extreme points. The circle of an arc extends beyond the points of the arc.",
    OTHERWISE,
)


def says(values: tuple[float, float, float]) -> str:
    return why_fit(Fit(ARC, values, WITHIN)).text


@pytest.mark.parametrize(
    ("values", "near", "words"),
    [
        ((Y, X, R), (Y, X, R + 0.1), "The two coordinates of the centre are swapped."),
        (
            (R, X, Y),
            (R + 0.1, X, Y),
            "The three numbers are right, but their order is wrong. Return the x and y of the",
        ),
        ((0.5, 0.5, 0.7), (0.6, 0.5, 0.7), "You get this result if the right side of the equations is x + y instead"),
        ((X, Y, R * R), (X, Y, R * R + 0.2), "This is the square of the radius. The equation of the circle contains r"),
        ((X, Y, 2 * R), (X, Y, 2 * R + 0.1), "This is the diameter, twice the radius."),
        (
            (X, Y, R * R - X * X - Y * Y),
            (X, Y, -20.0),
            "The third unknown is c = r² - a² - b², not r². To compute r², add",
        ),
        ((X, Y, 6.557), (X, Y, 8.0), "The third unknown is c = r² - a² - b², not r². To compute r², add"),
        ((X, Y, R + 0.03), (X, Y, R + 0.05), "A radius that is computed only from the outermost points contains all"),
        (
            (2 * X, 2 * Y, R),
            (2 * X, 2 * Y + 0.1, R),
            "The centre is twice as far away as it should be: the equation contains",
        ),
        ((-X, -Y, R), (-X, Y, R), "The centre has the wrong sign. Check on which side of the equation each term is."),
        (
            (-2 * X, -2 * Y, R),
            (-2 * X, Y, R),
            "The centre has the wrong sign. Check on which side of the equation each",
        ),
        (mean(), (mean()[0] + 0.1, *mean()[1:]), "This is the mean of the points. The mean is the centre only if the"),
        (
            between_extremes(),
            (between_extremes()[0] + 0.1, *between_extremes()[1:]),
            "This is the midpoint between the extreme points. The circle of an arc extends beyond the points of the",
        ),
        ((1.0, 2.0, 3.5), (X, Y, 2 * R), "The function computes a circle that does not fit the points."),
    ],
)
def test_each_mistake_is_known_by_its_numbers(
    values: tuple[float, float, float], near: tuple[float, float, float], words: str
) -> None:
    (sentence,) = (each for each in SENTENCES if each.startswith(words))
    assert (says(values), says(near) != sentence) == (sentence, True)


@pytest.mark.parametrize(
    ("call", "told"),
    [("min", True), ("max", True), ("ptp", True), ("sorted", True), ("mean", False), ("minimum", False)],
)
def test_only_code_that_computes_extremes_can_use_them(call: str, *, told: bool) -> None:
    code = evidence(recording([]), submission({NODE_FILE: f"{call}(x)\n"})).code
    fit = Fit(ARC, between_extremes(), WITHIN, extremes=uses_extremes(code))
    assert ("This is the midpoint between the extreme points." in why_fit(fit).text) == told


def test_a_radius_of_2_does_not_tell_the_square_from_the_diameter() -> None:
    arc = Arc(6.0, 4.0, 2.0, 20.0, 140.0, 300, 0.01)
    said = why_fit(Fit(arc, (6.0, 4.0, 4.0), WITHIN)).text
    assert said == "This is the square of the radius, or twice the radius."


@pytest.mark.parametrize(
    ("values", "told"), [((6.0, 7.0, 2.0), True), ((6.0, 7.1, 2.0), False), ((9.0, 7.0, 2.0), False)]
)
def test_rounded_values_are_told(values: tuple[float, float, float], *, told: bool) -> None:
    arc = Arc(5.5, 7.25, 1.75, 0.0, 356.4, 100, 0.0)
    said = why_fit(Fit(arc, values, WITHIN)).text
    assert ("The values are rounded to whole numbers. Return them without rounding." in said) == told
