"""The tolerance of a fitted circle follows from the noise: good fits are within it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.checks.causes.why_fit import Fit
from grader.checks.subjects.fit import tolerances
from grader.common.lazy import np
from grader.evidence.circle_fit import fit_circle
from grader.tests.checks.bag_step import EXERCISE

if TYPE_CHECKING:
    from grader.exercise.call_inputs import Arc

CALLS = [trial.calls for trial in EXERCISE.trials]
ARCS: dict[str, Arc] = {
    **{each.id: each.arc for calls in CALLS for each in calls.points if each.arc},
    **{each.id: each.arc for calls in CALLS for each in calls.bags},
}
SEEDS = range(40)
ROUNDING_M = 1e-3


def kasa(arc: Arc, seed: int) -> tuple[float, float, float]:
    """Return the circle that the lesson's method fits."""
    x, y = arc.points("test", seed)
    left = np.column_stack((2 * x, 2 * y, np.ones(len(x))))
    a, b, c = (float(each) for each in np.linalg.lstsq(left, x**2 + y**2, rcond=None)[0])
    return a, b, float(np.sqrt(c + a**2 + b**2))


@pytest.mark.parametrize("name", ARCS)
def test_sound_fits_are_within_the_tolerance(name: str) -> None:
    arc = ARCS[name]
    for seed in SEEDS:
        taubin = fit_circle(*arc.points("test", seed))
        assert taubin is not None
        for values in (kasa(arc, seed), (taubin.x, taubin.y, taubin.radius)):
            assert Fit(arc, values, tolerances(arc, ROUNDING_M)).right, seed


@pytest.mark.parametrize("name", ["noise", "arc", "elsewhere"])
def test_the_tolerance_is_that_of_the_noise(name: str) -> None:
    """The errors of the lesson's fit have the standard deviation from which the tolerance is computed."""
    arc = ARCS[name]
    errors = [kasa(arc, seed)[2] - arc.radius_m for seed in SEEDS]
    rms = float(np.sqrt(np.mean(np.square(errors))))
    assert 0.6 < rms / arc.deviations()[2] < 1.6


def test_the_noise_is_the_same_for_the_same_seed_alone() -> None:
    arc = ARCS["noise"]
    assert (arc.points("a", 1)[0] == arc.points("a", 1)[0]).all()
    assert not (arc.points("a", 1)[0] == arc.points("a", 2)[0]).all()
    assert not (arc.points("a", 1)[0] == arc.points("b", 1)[0]).all()
