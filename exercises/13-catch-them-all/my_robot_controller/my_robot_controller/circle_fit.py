"""Fit a circle to points."""

import numpy as np


def fit_circle(x, y):
    """Return x and y of the centre, and the radius, of the circle that fits the points best (all in m)."""
    # TODO 2: reject points that form no circle (ValueError), then solve the linear equations from the lesson.
    return 0.0, 0.0, 0.0
