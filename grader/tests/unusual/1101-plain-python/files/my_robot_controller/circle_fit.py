"""Fit a circle with sums alone."""

from math import sqrt


def det(a, b, c, d):
    return a * d - b * c


def fit_circle(x, y):
    n = len(x)
    if n != len(y) or n < 3:
        raise ValueError("three points at least")
    mx, my = sum(x) / n, sum(y) / n
    u = [v - mx for v in x]
    v = [w - my for w in y]
    suu, svv = sum(a * a for a in u), sum(a * a for a in v)
    suv = sum(a * b for a, b in zip(u, v))
    e = sum(a * a * a + a * b * b for a, b in zip(u, v)) / 2
    f = sum(b * b * b + a * a * b for a, b in zip(u, v)) / 2
    d = det(suu, suv, suv, svv)
    if abs(d) < 1e-9 * (suu + svv) ** 2:
        raise ValueError("no circle")
    a, b = det(e, suv, f, svv) / d, det(suu, e, suv, f) / d
    return mx + a, my + b, sqrt(a * a + b * b + (suu + svv) / n)
