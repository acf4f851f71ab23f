from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest
from PIL import Image

from grader.turtlesim.canvas import BACKGROUND, Canvas
from grader.turtlesim.turtle import FRAME_S, Pen, Start
from grader.turtlesim.world import World

if TYPE_CHECKING:
    from pathlib import Path

RED = Pen((255, 0, 0), 1)


def drawn(canvas: Canvas) -> set[tuple[int, int]]:
    image = canvas.image()
    return {(x, y) for x in range(500) for y in range(500) if image.getpixel((x, y)) != canvas.background}


def test_an_untouched_canvas_shows_its_background() -> None:
    assert Canvas().color_at(5.0, 5.0) == BACKGROUND == (69, 86, 255)


@pytest.mark.parametrize(
    ("x", "y", "pixel"),
    [(0.0, 0.0, (0, 499)), (0.0, 11.0888, (0, 0)), (11.0888, 0.0, (499, 499)), (1.0, 2.0, (45, 409))],
)
def test_a_metre_is_45_pixels_and_y_points_up(x: float, y: float, pixel: tuple[int, int]) -> None:
    canvas = Canvas()
    canvas.line(x, y, x, y, RED)
    assert drawn(canvas) == {pixel}
    assert canvas.color_at(x, y) == RED.color


def test_a_line_has_its_width() -> None:
    canvas = Canvas()
    canvas.line(2.0, 5.0, 8.0, 5.0, Pen((255, 0, 0), 5))
    column = {y for x, y in drawn(canvas) if x == 200}
    row = round((11.088889 - 5.0) * 45)
    assert column == set(range(row - 2, row + 3))


def test_a_slow_turtle_leaves_no_gap() -> None:
    world = World(Start(2.0, 2.0, 0.0))
    world.turtles["turtle1"].pen = RED
    for frame in range(1000):
        world.command("turtle1", 0.3, 0.0, 0.1)
        world.step(frame * FRAME_S)
    pixels = drawn(world.canvas)
    alone = [
        p for p in pixels if not any((p[0] + i, p[1] + j) in pixels for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j)
    ]
    assert len(pixels) > 150
    assert alone == []


def test_the_latest_line_lies_on_top() -> None:
    canvas = Canvas()
    canvas.line(2.0, 5.0, 8.0, 5.0, RED)
    canvas.line(5.0, 2.0, 5.0, 8.0, Pen((0, 255, 0), 1))
    assert canvas.color_at(5.0, 5.0) == (0, 255, 0)


def test_another_background_shows_at_once_and_leaves_the_trail() -> None:
    canvas = Canvas()
    canvas.line(2.0, 5.0, 8.0, 5.0, RED)
    canvas.background = (1, 2, 3)
    assert canvas.color_at(1.0, 1.0) == (1, 2, 3)
    assert canvas.color_at(5.0, 5.0) == RED.color


def test_clear_leaves_the_background() -> None:
    canvas = Canvas()
    canvas.line(2.0, 5.0, 8.0, 5.0, RED)
    canvas.clear()
    assert drawn(canvas) == set()


@pytest.mark.parametrize("end", [math.nan, math.inf, -math.inf])
def test_a_line_to_nowhere_is_not_drawn(end: float) -> None:
    canvas = Canvas()
    canvas.line(5.0, 5.0, end, 5.0, RED)
    assert drawn(canvas) == set()


@pytest.mark.parametrize("where", [(math.nan, 5.0), (-1.0, 5.0), (5.0, 1e300), (math.inf, 0.0)])
def test_the_sensor_sees_the_background_where_there_is_no_canvas(where: tuple[float, float]) -> None:
    assert Canvas().color_at(*where) == BACKGROUND


def test_a_line_may_leave_the_canvas() -> None:
    canvas = Canvas()
    canvas.line(5.0, 5.0, 3e38, 5.0, RED)
    assert canvas.color_at(11.0, 5.0) == RED.color


def test_a_turtle_with_its_pen_up_leaves_no_trail() -> None:
    world = World()
    world.turtles["turtle1"].pen = Pen(down=False)
    world.command("turtle1", 2.0, 0.0, 0.0)
    world.turtles["turtle1"].teleport_absolute(2.0, 2.0, 0.0)
    world.step(0.0)
    assert drawn(world.canvas) == set()


def test_a_teleport_draws_a_line() -> None:
    world = World()
    world.turtles["turtle1"].teleport_absolute(2.0, 5.544445, 0.0)
    world.step(0.0)
    assert world.canvas.color_at(4.0, 5.544445) == (179, 184, 255)


def test_a_turtle_at_rest_draws_nothing() -> None:
    world = World()
    for frame in range(10):
        world.step(frame * FRAME_S)
    assert drawn(world.canvas) == set()


def test_the_sensor_looks_before_the_pen_draws() -> None:
    world = World()
    turtle = world.turtles["turtle1"]
    world.command("turtle1", 10.0, 0.0, 0.0)
    world.step(0.0)
    assert turtle.color == BACKGROUND
    world.command("turtle1", 0.0, 0.0, 0.0)
    world.step(FRAME_S)
    assert turtle.color == turtle.pen.color


def test_the_picture_is_a_png_of_500_by_500(tmp_path: Path) -> None:
    canvas = Canvas()
    canvas.line(1.0, 2.0, 1.0, 2.0, RED)
    path = tmp_path / "canvas.png"
    canvas.save(path)
    with Image.open(path) as image:
        assert (image.format, image.size, image.mode) == ("PNG", (500, 500), "RGB")
        assert image.getpixel((45, 409)) == RED.color
        assert image.getpixel((44, 409)) == BACKGROUND
