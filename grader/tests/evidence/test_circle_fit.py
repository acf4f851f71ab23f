"""The circle fit, tested with properties that hold for any circle."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.evidence.circle_fit import fit_circle, turns_about

if TYPE_CHECKING:
    from grader.trial.recording import Floats

CENTRES = st.floats(-20.0, 20.0)
RADII = st.floats(0.05, 20.0)
ARCS = st.floats(0.5, 12.0)
"""The angle of the arc on which the points lie (rad)."""


def arc(
    x: float, y: float, radius: float, sweep: float, begin: float = 0.0, points: int = 200
) -> tuple[Floats, Floats]:
    angle = begin + np.linspace(0.0, sweep, points)
    return x + radius * np.cos(angle), y + radius * np.sin(angle)


@given(CENTRES, CENTRES, RADII, ARCS, st.floats(-4.0, 4.0))
def test_finds_the_circle_that_points_lie_on(x: float, y: float, radius: float, sweep: float, begin: float) -> None:
    found = fit_circle(*arc(x, y, radius, sweep, begin))
    assert found is not None
    assert found.radius == pytest.approx(radius, rel=1e-6)
    assert math.dist((found.x, found.y), (x, y)) <= 1e-6 * (1.0 + radius)
    assert found.rms <= 1e-6 * (1.0 + radius)


@given(CENTRES, CENTRES, st.floats(0.5, 5.0), st.floats(3.0, 12.0), st.integers(0, 1000))
def test_noise_moves_the_circle_by_no_more_than_itself(
    x: float, y: float, radius: float, sweep: float, seed: int
) -> None:
    noise = np.random.default_rng(seed)
    px, py = arc(x, y, radius, sweep)
    found = fit_circle(px + noise.normal(0.0, 0.01, len(px)), py + noise.normal(0.0, 0.01, len(py)))
    assert found is not None
    assert found.radius == pytest.approx(radius, abs=0.01)
    assert math.dist((found.x, found.y), (x, y)) <= 0.015
    assert 0.006 <= found.rms <= 0.014


@given(st.floats(-100.0, 100.0), st.floats(-100.0, 100.0))
def test_moving_the_points_moves_the_centre_alone(dx: float, dy: float) -> None:
    px, py = arc(1.0, 2.0, 1.5, 5.0)
    rough = px + 0.02 * np.cos(7.0 * np.arange(len(px)))
    here, there = fit_circle(rough, py), fit_circle(rough + dx, py + dy)
    assert here is not None
    assert there is not None
    assert (there.x - dx, there.y - dy) == pytest.approx((here.x, here.y), abs=1e-9)
    assert (there.radius, there.rms) == pytest.approx((here.radius, here.rms), abs=1e-9)


def test_the_residual_of_a_square_is_its_distance_from_the_circle() -> None:
    side = np.linspace(-1.0, 1.0, 2001)
    one = np.ones_like(side)
    found = fit_circle(np.concatenate((side, one, -side, -one)), np.concatenate((-one, side, one, -side)))
    assert found is not None
    distance = np.sqrt(1.0 + side**2)
    assert found.rms == pytest.approx(float(distance.std()), rel=0.01)


@pytest.mark.parametrize(
    ("x", "y"),
    [
        ([], []),
        ([1.0, 2.0], [0.0, 1.0]),
        ([3.0] * 9, [4.0] * 9),
        ([0.0, 1.0, 2.0, 3.0], [1.0, 3.0, 5.0, 7.0]),
        ([0.0, 1.0, math.nan], [0.0, 1.0, 0.0]),
        ([0.0, 1.0, math.inf], [0.0, 1.0, 0.0]),
    ],
    ids=["none", "two", "one place", "a line", "nan", "infinity"],
)
def test_points_without_a_single_circle_give_none(x: list[float], y: list[float]) -> None:
    assert fit_circle(np.array(x), np.array(y)) is None


@given(st.floats(-20.0, 20.0))
def test_turns_count_both_directions_and_more_than_one(turns: float) -> None:
    px, py = arc(3.0, -1.0, 2.0, turns * 2.0 * math.pi, points=400)
    assert turns_about(px, py, 3.0, -1.0) == pytest.approx(turns, abs=1e-9)
