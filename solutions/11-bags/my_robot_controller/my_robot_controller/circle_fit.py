"""Fit a circle to points."""

import numpy as np


def fit_circle(x, y):
    """Return x and y of the centre, and the radius, of the circle that fits the points best (all in m)."""
    # BEGIN SOLUTION
    x = np.asarray(x, dtype=float)
    y = np.asarray(y, dtype=float)
    if len(x) != len(y):
        message = f"x and y have different lengths: {len(x)} and {len(y)}"
        raise ValueError(message)
    if len(x) < 3:
        message = f"a circle needs three points, not {len(x)}"
        raise ValueError(message)
    # (x - a)² + (y - b)² = r²  is the same as  2 x a + 2 y b + c = x² + y²  with  c = r² - a² - b²
    left = np.column_stack((2 * x, 2 * y, np.ones(len(x))))
    right = x**2 + y**2
    (a, b, c), _, rank, _ = np.linalg.lstsq(left, right, rcond=None)
    if rank < 3:
        message = "the points are on a straight line"
        raise ValueError(message)
    return a, b, np.sqrt(c + a**2 + b**2)
    # END SOLUTION
    # BEGIN STARTER
    # # TODO 2: reject points that form no circle (ValueError), then solve the linear equations from the lesson.
    # return 0.0, 0.0, 0.0
    # END STARTER
