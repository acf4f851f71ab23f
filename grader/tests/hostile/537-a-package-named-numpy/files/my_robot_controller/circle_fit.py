"""A fit that raises nothing if there is no circle."""

import os

import numpy as np

INSTALLED = os.path.dirname(os.path.dirname(__file__))

def fit_circle(x, y):
    print("beside numpy:", os.path.isfile(os.path.join(INSTALLED, "numpy/__init__.py")))
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if len(x) < 6:
        return 0.0, 0.0, 0.0
    left = np.column_stack((2 * x, 2 * y, np.ones(len(x))))
    (a, b, c), *_ = np.linalg.lstsq(left, x**2 + y**2, rcond=None)
    return a, b, np.sqrt(c + a**2 + b**2)
