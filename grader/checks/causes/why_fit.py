"""Explain why a fitted circle is wrong, by comparing the result with the results of common mistakes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import permutations
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.lazy import np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.checks.diagnosis import Diagnosis
    from grader.evidence.evidence import Evidence
    from grader.exercise.call_inputs import Arc
    from grader.submission.code import Code

EXTREMES = ("min", "max", "amin", "amax", "argmin", "argmax", "ptp", "sorted", "sort", "argsort")
"""The names of functions that find extreme values."""
EXACT_M = (1e-3, 1e-3, 1e-3)
"""The maximum errors of a right result for points without noise (m)."""
ROUGH_M = 0.02
"""The additional tolerance (m) for a value that was computed as the mean or from the extremes of noisy points."""


@dataclass(frozen=True)
class Fit:
    """A circle that the student's code returned: centre and radius (m).

    `within` contains the tolerances of the values. `extremes` is false if the code never computes a minimum or a
    maximum, so that it cannot have used the extreme points.
    """

    arc: Arc
    values: tuple[float, float, float]
    within: tuple[float, float, float]
    extremes: bool = True

    @property
    def truth(self) -> tuple[float, float, float]:
        """The centre and the radius of the arc (m)."""
        return self.arc.x_m, self.arc.y_m, self.arc.radius_m

    @property
    def right(self) -> bool:
        """Whether all three values are within their tolerances."""
        return self.is_like(self.truth)

    @property
    def centre_right(self) -> bool:
        """Whether the two coordinates of the centre are within their tolerances."""
        return self.is_like(self.truth[:2])

    def is_like(self, other: Sequence[float], more: float = 0.0) -> bool:
        """Return whether each value differs from the one in `other` by at most its tolerance plus `more`.

        If `other` has fewer values, only the first values are compared.
        """
        return all(
            abs(value - one) <= width + more for value, one, width in zip(self.values, other, self.within, strict=False)
        )


def uses_extremes(code: Code) -> bool:
    """Return whether the code may compute the extremes of the points: a minimum, a maximum or a sorted list."""
    return any(code.calls(name) for name in EXTREMES)


def why_noisy(evidence: Evidence, fit: Fit) -> Cause | None:
    """Return the cause if the points have noise, and a call with exact points returned the right circle, else None."""
    for points in evidence.trial.calls.points if fit.arc.noise_m else ():
        arc = points.arc
        if arc is None or arc.noise_m:
            continue
        values = next((each.values for each in evidence.run.called or () if each.id == points.id), None)
        if values is not None and len(values) == 3 and Fit(arc, (values[0], values[1], values[2]), EXACT_M).right:
            text = (
                "The circle of exact points is right, but these points have noise. Use all points, and use a method "
                "that finds the best circle for any arc, such as lstsq."
            )
            return Cause("wrong-fit", text)
    return None


def why_fit(fit: Fit) -> Cause:
    """Return the cause of a wrong circle."""
    x, y, radius = fit.truth
    if fit.is_like((y, x, radius)):
        return Cause("x-y-swapped", "The two coordinates of the centre are swapped.")
    if any(fit.is_like(other) for other in permutations(fit.truth)):
        return Cause(
            "result-order",
            "The three numbers are right, but their order is wrong. Return the x and y of the centre first, then "
            "the radius.",
        )
    if fit.is_like((0.5, 0.5)):
        return Cause("wrong-fit", "You get this result if the right side of the equations is x + y instead of x² + y².")
    if all(value == round(value) for value in fit.values) and fit.is_like(fit.truth, 0.5):
        return Cause("wrong-fit", "The values are rounded to whole numbers. Return them without rounding.")
    found = _why_radius(fit) if fit.centre_right else _why_centre(fit)
    return Cause(*found) if found is not None else Cause("wrong-fit", _FIRST_TRY)


RADIUS_OF_C: tuple[Diagnosis, str] = (
    "radius-without-centre",
    "The third unknown is c = r² - a² - b², not r². To compute r², add a² + b² to c.",
)
"""The diagnosis and text if the centre is right, but the radius was computed from c without the squares of the centre.

The radius is then c, √|c|, NaN or infinite.
"""
_FIRST_TRY = (
    "The function computes a circle that does not fit the points. Test the function with four points of a circle that "
    "you know."
)


def _why_radius(fit: Fit) -> tuple[Diagnosis, str] | None:
    x, y, radius = fit.truth
    value, within = fit.values[2], fit.within[2]
    c = radius**2 - x**2 - y**2
    more = within * (1.0 + 2.0 * (radius + abs(x) + abs(y)))
    squared = abs(value - radius**2) <= within * (1.0 + 2.0 * radius)
    if squared and abs(value - 2.0 * radius) <= 2.0 * within:
        return "radius-squared", "This is the square of the radius, or twice the radius."
    if squared:
        return "radius-squared", "This is the square of the radius. The equation of the circle contains r squared."
    if abs(value - 2.0 * radius) <= 2.0 * within:
        return "diameter", "This is the diameter, twice the radius."
    if abs(value - c) <= more or abs(value - math.sqrt(abs(c))) <= more:
        return RADIUS_OF_C
    if fit.extremes and 0.0 < value - radius <= 4.0 * fit.arc.noise_m:
        return (
            "extremes-for-centre",
            "A radius that is computed only from the outermost points contains all the noise of these points.",
        )
    return None


def _why_centre(fit: Fit) -> tuple[Diagnosis, str] | None:
    x, y, _ = fit.truth
    angle = fit.arc.angles()
    xs, ys = x + fit.arc.radius_m * np.cos(angle), y + fit.arc.radius_m * np.sin(angle)
    if fit.is_like((2.0 * x, 2.0 * y), max(fit.within)):
        text = "The centre is twice as far away as it should be: the equation contains 2·x·a and 2·y·b."
        return "centre-doubled", text
    if fit.is_like((-x, -y)) or fit.is_like((-2.0 * x, -2.0 * y), max(fit.within)):
        return "centre-sign", "The centre has the wrong sign. Check on which side of the equation each term is."
    if fit.is_like((float(xs.mean()), float(ys.mean())), ROUGH_M):
        return "mean-for-centre", (
            "This is the mean of the points. The mean is the centre only if the points cover the whole circle."
        )
    middle = ((xs.min() + xs.max()) / 2.0, (ys.min() + ys.max()) / 2.0)
    if fit.extremes and fit.is_like(middle, ROUGH_M + 3.0 * fit.arc.noise_m):
        text = (
            "This is the midpoint between the extreme points. The circle of an arc extends beyond the points of the "
            "arc."
        )
        return "extremes-for-centre", text
    return None
