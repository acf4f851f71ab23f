"""Fit a circle to points, and count the turns about a centre. Lengths are in m, angles in rad."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.lazy import np

if TYPE_CHECKING:
    from grader.trial.recording import Floats

FLAT = 1e-9
"""If the quadratic part of a fit is smaller than this, the points are considered to be on a straight line."""


@dataclass(frozen=True)
class Circle:
    """A circle with its centre and radius (m).

    `rms` is the root mean square distance of the points from the circle (m).
    """

    x: float
    y: float
    radius: float
    rms: float


def fit_circle(x: Floats, y: Floats) -> Circle | None:
    """Return the circle that fits the points best, or None for fewer than three points or points on a straight line.

    `x` and `y` have the shape (N,). The result is None if a coordinate is not finite. The fit is algebraic, with
    Taubin's constraint, which does not shrink short arcs: Taubin, "Estimation of planar curves, surfaces and nonplanar
    space curves defined by implicit equations", IEEE Transactions on PAMI 13 (1991) 1115-1138. The fit is computed from
    singular values as in Chernov, "Circular and Linear Regression" (2010), sections 5.9 and 5.10.
    """
    if len(x) < 3 or not (np.isfinite(x).all() and np.isfinite(y).all()):
        return None
    middle_x, middle_y = float(x.mean()), float(y.mean())
    scale = float(np.sqrt(((x - middle_x) ** 2 + (y - middle_y) ** 2).mean()))
    if not scale > 0.0:
        return None
    u, v = (x - middle_x) / scale, (y - middle_y) / scale
    square = u**2 + v**2
    mean = float(square.mean())
    lifted = (square - mean) / (2.0 * np.sqrt(mean))
    a, b, c = (float(each) for each in np.linalg.svd(np.column_stack((lifted, u, v)), full_matrices=False)[2][2])
    a /= 2.0 * np.sqrt(mean)
    if not abs(a) > FLAT:
        return None
    centre_x, centre_y = -b / (2.0 * a), -c / (2.0 * a)
    radius = float(np.sqrt(b**2 + c**2 + 4.0 * a**2 * mean)) / (2.0 * abs(a))
    distance = np.hypot(u - centre_x, v - centre_y) - radius
    rms = float(np.sqrt((distance**2).mean()))
    return Circle(middle_x + scale * centre_x, middle_y + scale * centre_y, scale * radius, scale * rms)


def turns_about(x: Floats, y: Floats, centre_x: float, centre_y: float) -> float:
    """Return the number of turns about a centre, positive if counter-clockwise.

    Each step must be less than half a turn.
    """
    if len(x) < 2:
        return 0.0
    angle = np.unwrap(np.arctan2(y - centre_y, x - centre_x))
    return float(angle[-1] - angle[0]) / (2.0 * float(np.pi))
