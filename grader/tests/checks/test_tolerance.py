from __future__ import annotations

import math

import pytest

from grader.checks.cause import Cause
from grader.checks.outcome import Status, failed, passed
from grader.checks.tolerance import Band, unless_starved
from grader.tests.checks.made import recording

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


WRONG = failed("The circle is too large.", "It is smaller.", Cause("wrong-radius"))


@pytest.mark.parametrize(
    ("stalls", "off", "starved"),
    [
        (((1.0, 1.5),), 0.4, True),
        (((1.0, 1.5),), 0.5, True),
        (((1.0, 1.5),), 0.6, False),
        ((), 0.4, False),
        ((), 0.0, False),
    ],
)
def test_only_a_stall_that_is_long_enough_explains_a_wrong_value(
    stalls: tuple[tuple[float, float], ...], off: float, *, starved: bool
) -> None:
    trial = recording([], clock="wall", stalls=stalls)
    found = unless_starved(WRONG, trial, off, per_s=1.0)
    words = "The machine was too busy to judge the check in wall time. Try again when the machine is less busy."
    assert (found.status is Status.ERROR, found.observed == words) == (starved, starved)
    assert unless_starved(passed("It is right."), trial, off, per_s=1.0).status is Status.PASSED
