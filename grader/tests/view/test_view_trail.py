from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.turtlesim.turtle import SIDE_M
from grader.view.trail import FAR, MOST_POINTS, Stroke, Trail, as_lists, place

INK = (179, 184, 255, 3)


def chain(points: list[tuple[float, float]]) -> list[tuple[float, float, float, float, int, int, int, int]]:
    return [(*begin, *end, *INK) for begin, end in itertools.pairwise(points)]


def circle(count: int, radius: float = 2.0) -> list[tuple[float, float]]:
    return [(5 + radius * math.cos(0.016 * n), 5 + radius * math.sin(0.016 * n)) for n in range(count)]


def distance(point: tuple[int, int], points: list[tuple[int, int]]) -> float:
    """Return the distance of a point from a line through points."""

    def to_piece(begin: tuple[int, int], end: tuple[int, int]) -> float:
        length = math.dist(begin, end)
        if length == 0:
            return math.dist(point, begin)
        share = sum((p - b) * (e - b) for p, b, e in zip(point, begin, end, strict=True)) / length**2
        share = min(max(share, 0.0), 1.0)
        return math.dist(point, [b + share * (e - b) for b, e in zip(begin, end, strict=True)])

    return min(to_piece(begin, end) for begin, end in itertools.pairwise(points))


def test_frames_make_one_stroke_with_few_points() -> None:
    trail = Trail()
    points = circle(393)
    for line in chain(points):
        trail.draw([line])
    (stroke,) = trail.strokes
    assert len(stroke.points) < len(points) / 3
    # The limit is a fifth of a pixel.
    assert max(distance(place(*point), stroke.points) for point in points) < 2.0


def test_a_straight_path_is_two_points() -> None:
    trail = Trail()
    trail.draw(chain([(1 + 0.032 * n, 2.0) for n in range(200)]))
    assert [len(stroke.points) for stroke in trail.strokes] == [math.ceil(199 / 41) + 1]


def test_a_slow_turtle_leaves_a_trail_too() -> None:
    trail = Trail()
    for line in chain([(5 + 0.00001 * n, 5.0) for n in range(3000)]):
        trail.draw([line])
    (stroke,) = trail.strokes
    assert stroke.points[-1] == place(5.02999, 5.0)


def test_two_turtles_that_take_turns_have_a_stroke_each() -> None:
    trail = Trail()
    first, second = chain(circle(50)), chain(circle(50, radius=1.0))
    for pair in zip(first, second, strict=True):
        trail.draw(list(pair))
    assert len(trail.strokes) == 2


def test_another_pen_is_another_stroke() -> None:
    trail = Trail()
    trail.draw([(0, 0, 1, 1, 255, 0, 0, 3), (1, 1, 2, 1, 0, 255, 0, 3)])
    assert [stroke.pen for stroke in trail.strokes] == [(255, 0, 0, 3), (0, 255, 0, 3)]


def test_a_page_gets_what_is_new_from_the_end_of_the_line() -> None:
    trail = Trail()
    trail.draw([(1, 1, 2, 1, *INK)])
    (piece,) = trail.draw([(2, 1, 2, 2, *INK)])
    assert piece.points == [place(2, 1), place(2, 2)]


def test_a_trail_without_end_becomes_a_picture_and_goes_on() -> None:
    trail = Trail()
    zigzag = chain([(9.0 * (n % 2), float(n % 10)) for n in range(MOST_POINTS + 100)])
    trail.draw(zigzag)
    before = trail.painted(500).getbbox()
    assert trail.picture
    assert sum(len(stroke.points) for stroke in trail.strokes) < MOST_POINTS / 2
    trail.draw([(5.0, 9.0, 5.0, 11.0, *INK)])
    after = trail.painted(500).getbbox()
    assert before is not None
    assert after is not None
    # The picture contains the earlier lines and a line that is higher.
    assert after[1] < before[1]
    assert (after[0], *after[2:]) == (before[0], *before[2:])


def test_clearing_leaves_nothing() -> None:
    trail = Trail()
    trail.take_picture(b"")
    trail.draw(chain(circle(20)))
    trail.clear()
    assert trail.as_message() == {"picture": None, "strokes": []}


@given(st.lists(st.tuples(st.floats(-1e300, 1e300), st.floats(-1e300, 1e300)), min_size=2, max_size=30))
def test_a_stroke_stays_near_all_its_points(points: list[tuple[float, float]]) -> None:
    stroke = Stroke(INK, [place(*points[0])])
    for point in points[1:]:
        stroke.add(place(*point))
    assert all(abs(value) <= FAR for point in stroke.points for value in point)
    assert all(distance(place(*point), [*stroke.points, stroke.points[-1]]) <= 2.0 for point in points)


def test_a_page_gets_whole_numbers() -> None:
    assert as_lists([Stroke((1, 2, 3, 4), [place(0, SIDE_M), place(SIDE_M, 0)])]) == [[1, 2, 3, 4, 0, 0, 4990, 4990]]


def test_pictures_are_painted_in_the_pen_s_colour() -> None:
    trail = Trail()
    trail.draw([(1, 5, 9, 5, *INK)])
    x, y = place(5, 5)
    assert trail.painted(1000).getpixel((x // 5, y // 5)) == pytest.approx((*INK[:3], 255))
