"""Test the square with this project's model of turtlesim's motion. The commands arrive some frames late."""

from __future__ import annotations

import math
from collections import deque

import pytest

from grader.turtlesim.programs.square_velocity import SIDE_M, Leg, first, follow
from grader.turtlesim.turtle import FRAME_S
from grader.turtlesim.world import World

Point = tuple[float, float]


def drive(late: int, seconds: float = 36.0) -> tuple[list[Point], list[Leg]]:
    """Return the position of the turtle in each frame, and the sections of its path in order."""
    world = World()
    turtle = world.turtles["turtle1"]
    legs = [first(turtle.x, turtle.y, turtle.theta)]
    commands = deque([(0.0, 0.0)] * late)
    places = []
    for frame in range(int(seconds / FRAME_S)):
        leg, *command = follow(legs[-1], turtle.x, turtle.y, turtle.theta)
        legs += [leg] if leg != legs[-1] else []
        commands.append((command[0], command[1]))
        linear, angular = commands.popleft()
        world.command("turtle1", linear, 0.0, angular)
        world.step(frame * FRAME_S)
        places.append((turtle.x, turtle.y))
    return places, legs


def off_the_square(place: Point, corners: list[Point]) -> float:
    """Return the distance to the nearest side of a square whose sides are parallel to the axes (m)."""
    (left, bottom), (right, top) = corners[0], corners[2]
    x, y = min(max(place[0], left), right), min(max(place[1], bottom), top)
    inside = min(x - left, right - x, y - bottom, top - y)
    return max(inside, math.dist(place, (x, y)))


@pytest.mark.parametrize("late", [0, 1, 3, 6])
def test_the_turtle_drives_a_square_of_two_metres(late: int) -> None:
    places, legs = drive(late)
    x, y = 5.544445, 5.544445
    corners = [(x, y), (x + SIDE_M, y), (x + SIDE_M, y + SIDE_M), (x, y + SIDE_M)]
    assert max(off_the_square(place, corners) for place in places) < 0.02
    for corner in corners:
        assert min(math.dist(place, corner) for place in places) < 0.01
    # The turtle has driven four sides with a turn each, and continues.
    assert [leg.turning for leg in legs[:9]] == [False, True] * 4 + [False]


def test_it_turns_left_at_a_corner() -> None:
    leg, linear, angular = follow(Leg(1.0, 1.0, 0.0), 1.0, 1.0, 0.0)
    assert leg.turning
    assert (linear, angular) == (0.0, 0.4)


def test_it_never_drives_faster_than_a_metre_a_second() -> None:
    assert follow(Leg(100.0, 0.0, 0.0), 0.0, 0.0, 0.0)[1:] == (1.0, 0.0)


def test_the_last_turn_goes_on_over_the_seam_of_the_angle() -> None:
    # A turn from west to south goes from pi to -pi/2.
    _, _, angular = follow(Leg(0.0, 0.0, math.pi, turning=True), 0.0, 0.0, -math.pi + 0.1)
    assert angular > 0
