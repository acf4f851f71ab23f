"""Fit a circle step by step."""

import numpy as np


def fit_circle(x, y):
    x, y = np.array(x, float), np.array(y, float)
    if x.shape != y.shape or x.size < 3:
        raise ValueError("at least three points")
    spread = np.linalg.svd(np.stack([x - x.mean(), y - y.mean()]), compute_uv=False)
    if spread[1] < 1e-9 * spread[0]:
        raise ValueError("all on one line")
    circle = np.array([x.mean(), y.mean(), x.std() + y.std()])
    for _ in range(200):
        dx, dy = x - circle[0], y - circle[1]
        distance = np.hypot(dx, dy)
        slopes = np.stack([-dx / distance, -dy / distance, -np.ones_like(x)], axis=1)
        step = np.linalg.lstsq(slopes, circle[2] - distance, rcond=None)[0]
        circle = circle + step
        if np.abs(step).max() < 1e-10:
            break
    return tuple(circle)
