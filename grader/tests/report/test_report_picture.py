"""The picture of a run, tested by the colours of its pixels."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from grader.errors import UsageError
from grader.evidence.evidence import Run
from grader.exercise.model import Scenario, TrialSpec
from grader.exercise.node_under_test import Behaviour, TestsSpec
from grader.report.picture import BOTTOM, HEADING, LEFT, RIGHT, SIDE_PX, SMALL_PX, TOP, draw_picture, save_picture
from grader.report.shapes import LOOKS, SEA, SIDE_M
from grader.tests.checks.made import every, evidence, good, recording
from grader.tests.checks.shapes import SHAPES
from grader.tests.report.reports import EVIDENCE, report_of
from grader.trial.recording import Pose

if TYPE_CHECKING:
    from pathlib import Path

    from grader.evidence.evidence import Evidence

EXPECTED, FITTED, PEN, TICK, WALL = (LOOKS[role].color for role in ("expected", "fitted", "trajectory", "tick", "wall"))
Pixels = npt.NDArray[np.int16]


def canvas(given: Evidence) -> Pixels:
    image = np.asarray(draw_picture(given, report_of(given)), dtype=np.int16)
    return image[TOP : TOP + SIDE_PX, LEFT : LEFT + SIDE_PX]


def has(pixels: Pixels, color: tuple[int, int, int], off: int = 30) -> bool:
    return bool((np.abs(pixels - np.array(color, dtype=np.int16)).sum(axis=-1) <= off).any())


def around(pixels: Pixels, x: float, y: float, metres: float = 0.15) -> Pixels:
    scale = SIDE_PX / SIDE_M
    column, row, size = round(x * scale), round(SIDE_PX - y * scale), round(metres * scale)
    return pixels[max(row - size, 0) : row + size, max(column - size, 0) : column + size]


def test_the_path_is_drawn_where_the_turtle_drove() -> None:
    pixels = canvas(evidence(good()))
    for angle in np.linspace(0.3, 5.8, 9):
        place = around(pixels, 5.53 + 2.0 * np.cos(angle), 7.54 + 2.0 * np.sin(angle))
        assert has(place, PEN) or has(place, EXPECTED) or has(place, FITTED) or has(place, TICK)
    assert (around(pixels, 5.53, 7.54) == SEA).all()
    assert (around(pixels, 2.0, 2.0) == SEA).all()


def test_a_wrong_radius_shows_both_circles_apart() -> None:
    pixels = canvas(evidence(SHAPES["radius 2.2"]()))
    driven, requested = 5.544 + 2.2 + 2.2, 5.544 + 2.0 + 2.0
    assert has(around(pixels, 5.53, driven), PEN)
    assert not has(around(pixels, 5.53, requested), PEN)
    ring = [around(pixels, 5.53 + 2.0 * np.cos(a), 7.54 + 2.0 * np.sin(a)) for a in np.linspace(1.0, 2.2, 12)]
    assert any(has(place, EXPECTED) for place in ring)


def test_another_start_moves_the_required_circle() -> None:
    moved = canvas(evidence(recording(every(0.5, 2.0, 1.0), start=Pose(4.0, 6.0, 2.2))))
    assert (moved != canvas(evidence(good()))).any()
    assert has(around(moved, 4.0, 6.0), FITTED)


def test_the_wall_is_marked() -> None:
    assert has(canvas(evidence(SHAPES["wall"]())), WALL)
    assert not has(canvas(evidence(good())), WALL)


@pytest.mark.parametrize("shape", ["no messages", "all zero", "nan", "infinity"])
def test_a_picture_without_a_trajectory_says_so(shape: str) -> None:
    pixels = canvas(evidence(SHAPES[shape]()))
    words = around(pixels, SIDE_M / 2, SIDE_M * 0.28, 1.0)
    assert has(words, TICK)
    assert not has(canvas(evidence(good()))[400:500, 200:440], TICK)


@pytest.mark.parametrize("status", sorted(EVIDENCE))
def test_every_report_has_a_picture(status: str, tmp_path: Path) -> None:
    file = tmp_path / "picture.png"
    save_picture(EVIDENCE[status], report_of(EVIDENCE[status]), file)
    with Image.open(file) as image:
        assert (image.format, image.width > SIDE_PX, image.height > SIDE_PX) == ("PNG", True, True)


@pytest.mark.parametrize("shape", sorted(SHAPES))
def test_every_shape_can_be_drawn(shape: str) -> None:
    given = evidence(SHAPES[shape]())
    assert draw_picture(given, report_of(given)).width


def test_a_title_of_any_length_and_script_fits() -> None:
    given = evidence(good())
    long = report_of(given, exercise_title="円を描く " * 80)
    assert draw_picture(given, long).size == draw_picture(given, report_of(given)).size


def test_a_trial_with_tests_has_no_picture() -> None:
    given = evidence(good())
    tests = TrialSpec("tests", "a", "a", Scenario(0.0), tests=TestsSpec("guard", "Guard", 1, 1.0, Behaviour()))
    exercise = replace(given.exercise, trials=(*given.exercise.trials, tests))
    both = replace(given, exercise=exercise, runs={**given.runs, "tests": Run()})
    assert draw_picture(both, report_of(given)).size == draw_picture(given, report_of(given)).size


def test_an_exercise_without_a_circle_has_a_picture() -> None:
    given = evidence(good())
    plain = replace(given.exercise, checks=tuple(c for c in given.exercise.checks if c.kind != "circle"))
    pixels = canvas(replace(given, exercise=plain))
    assert has(pixels, PEN)
    assert not has(pixels, EXPECTED)


def test_every_trial_has_a_canvas_of_its_own() -> None:
    given = evidence(good())
    first = given.exercise.trials[0]
    trials = (first, replace(first, id="again"), replace(first, id="late"))
    runs = {**given.runs, "again": Run(SHAPES["radius 2.2"]()), "late": Run()}
    given = replace(given, exercise=replace(given.exercise, trials=trials), runs=runs)
    page = np.asarray(draw_picture(given, report_of(given)), dtype=np.int16)
    wide, high = LEFT + SMALL_PX + RIGHT, HEADING + SMALL_PX + BOTTOM
    places = [(TOP + HEADING + row * high, LEFT + column * wide) for row in (0, 1) for column in (0, 1)]
    canvases = [page[top : top + SMALL_PX, left : left + SMALL_PX] for top, left in places]
    assert [has(pixels, SEA) for pixels in canvases] == [True, True, True, False]
    assert [has(pixels, PEN) for pixels in canvases] == [True, True, False, False]


def test_a_file_that_cannot_be_written_is_a_usage_error(tmp_path: Path) -> None:
    given = evidence(good())
    with pytest.raises(UsageError, match="cannot be written"):
        save_picture(given, report_of(given), tmp_path / "no" / "such" / "folder.png")
