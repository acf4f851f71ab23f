def fit_circle(x, y):
    if len(x) < 3:
        raise ValueError("three points are needed")
    (x1, x2, x3), (y1, y2, y3) = x[:3], y[:3]
    d = 2 * (x1 * (y2 - y3) + x2 * (y3 - y1) + x3 * (y1 - y2))
    if abs(d) < 1e-12:
        raise ValueError("the points are on a line")
    a = ((x1**2 + y1**2) * (y2 - y3) + (x2**2 + y2**2) * (y3 - y1) + (x3**2 + y3**2) * (y1 - y2)) / d
    b = ((x1**2 + y1**2) * (x3 - x2) + (x2**2 + y2**2) * (x1 - x3) + (x3**2 + y3**2) * (x2 - x1)) / d
    return a, b, ((x1 - a) ** 2 + (y1 - b) ** 2) ** 0.5
