"""Fit a circle by the method of Pratt."""

import numpy as np


def fit_circle(x, y):
    points = np.array([x, y], dtype=float).T
    if len(points) < 3 or np.linalg.matrix_rank(points - points.mean(axis=0), tol=1e-9) < 2:
        raise ValueError("these points determine no circle")
    middle = points.mean(axis=0)
    u, v = (points - middle).T
    rows = np.column_stack((u * u + v * v, u, v, np.ones_like(u)))
    _, s, right = np.linalg.svd(rows, full_matrices=False)
    if s[-1] < 1e-12 * s[0]:
        a = right[-1]
    else:
        w = right.T @ np.diag(s) @ right
        inverse = np.array([[0, 0, 0, -0.5], [0, 1, 0, 0], [0, 0, 1, 0], [-0.5, 0, 0, 0]])
        values, vectors = np.linalg.eig(w @ inverse @ w)
        a = np.linalg.solve(w, vectors[:, np.argsort(values.real)[1]].real)
    centre = -a[1:3] / (2 * a[0])
    radius = np.sqrt(a[1] ** 2 + a[2] ** 2 - 4 * a[0] * a[3]) / abs(2 * a[0])
    return [*(centre + middle), radius]
