import math


def wrapped(angle):
    return math.atan2(math.sin(angle), math.cos(angle))


class Heading:
    """Adds up by how much the turtle has turned."""

    def __init__(self):
        self.last = None
        self.total = 0.0

    def update(self, theta):
        if self.last is not None:
            self.total += wrapped(theta - self.last)
        self.last = theta
