from __future__ import annotations

import math

import pytest

from grader.checks.tolerance import Band

AROUND = Band.around(2.0, 0.1)


@pytest.mark.parametrize(("value", "holds"), [(1.9, True), (2.0, True), (2.1, True), (1.89, False), (2.11, False)])
def test_edges_are_inside(value: float, holds: bool) -> None:
    assert AROUND.holds(value) is holds


@pytest.mark.parametrize("band", [AROUND, Band.at_most(3.0), Band.at_least(-3.0), Band(None, None)])
def test_nan_is_never_inside_and_never_near(band: Band) -> None:
    assert not band.holds(math.nan)
    assert not band.near(math.nan)


@pytest.mark.parametrize(
    ("value", "near"), [(2.0, False), (2.079, False), (2.081, True), (2.119, True), (2.121, False), (1.881, True)]
)
def test_near_is_a_fifth_of_the_tolerance_on_both_sides_of_an_edge(value: float, near: bool) -> None:
    assert AROUND.near(value) is near


def test_each_edge_has_its_own_width() -> None:
    interval = Band.around(0.5, 0.10, 0.15)
    assert (interval.near(0.425), interval.near(0.415)) == (False, True)
    assert (interval.near(0.625), interval.near(0.615)) == (True, False)


def test_one_sided_bands_have_one_edge() -> None:
    assert Band.at_most(3.0).holds(-1e9)
    assert Band.at_least(1.0).holds(1e9)
    assert Band.at_most(3.0).near(3.5)
    assert not Band.at_most(3.0).near(-3.0)
