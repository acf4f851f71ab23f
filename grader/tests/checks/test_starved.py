"""A lack of CPU time is not blamed on the node, but a busy machine does not excuse any other failure."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.cause import Cause
from grader.checks.judge import judge
from grader.checks.outcome import Status, failed, passed
from grader.checks.starved import STARVED_S, TOO_BUSY, unless_starved
from grader.tests.checks.made import evidence, recording
from grader.tests.checks.shapes import SHAPES

WRONG = failed("The circle is too large.", "It is smaller.", Cause("wrong-radius"))
LONG = ((1.0, 1.2 + STARVED_S),)
SHORT = ((1.0, 0.8 + STARVED_S),)


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
    assert (found.status is Status.ERROR, found.observed == TOO_BUSY) == (starved, starved)
    assert unless_starved(passed("It is right."), trial, off, per_s=1.0).status is Status.PASSED


@pytest.mark.parametrize(
    ("shape", "blamed"),
    [
        ("no messages", False),
        ("late", False),
        ("three quarters", False),
        ("beside its place", False),
        ("ignores Ctrl-C", False),
        ("other name", True),
        ("all zero", True),
        ("crash at the start", True),
    ],
)
@pytest.mark.parametrize("stalls", [(), SHORT, LONG], ids=["no stall", "a short stall", "a long stall"])
def test_a_starved_node_is_blamed_only_for_what_no_busy_machine_explains(
    shape: str, stalls: tuple[tuple[float, float], ...], *, blamed: bool
) -> None:
    observed = replace(SHAPES[shape](), clock="wall", stalls=stalls)
    statuses = {outcome.status for outcome in judge(evidence(observed)) if not outcome.advice}
    assert (Status.FAILED in statuses) == (blamed or stalls != LONG)
    if stalls != LONG:
        assert Status.ERROR not in statuses
