from __future__ import annotations

import math

import pytest

from grader.trial.recording import Pose
from grader.trial.target_places import (
    CLEAR_M,
    HIGH_M,
    LONGEST_M,
    LOW_M,
    Target,
    draw_targets,
    nearest_first,
    to_withdraw,
)

START = Pose(5.544445, 5.544445, 0.0)
SEEDS = range(10)


@pytest.fixture(params=SEEDS)
def targets(request: pytest.FixtureRequest) -> tuple[Target, ...]:
    return draw_targets(5, START, request.param)


def test_the_same_seed_draws_the_same() -> None:
    assert draw_targets(5, START, 3) == draw_targets(5, START, 3) != draw_targets(5, START, 4)


def test_targets_are_on_the_field(targets: tuple[Target, ...]) -> None:
    assert all(LOW_M <= each <= HIGH_M for target in targets for each in (target.x, target.y))


def test_the_nearest_target_is_clearly_the_nearest_and_the_way_is_short(targets: tuple[Target, ...]) -> None:
    order = nearest_first(targets, START)
    x, y, way_m = START.x, START.y, 0.0
    for number, target in enumerate(order):
        to_m, *others_m = (math.hypot(each.x - x, each.y - y) for each in order[number:])
        assert all(each >= to_m + CLEAR_M for each in others_m)
        x, y, way_m = target.x, target.y, way_m + to_m
    assert way_m <= LONGEST_M


def test_other_rules_give_another_order(targets: tuple[Target, ...]) -> None:
    order = nearest_first(targets, START)
    assert [each.name for each in order] != sorted(each.name for each in targets)
    assert order != tuple(sorted(targets, key=lambda each: math.hypot(each.x - START.x, each.y - START.y)))


def test_without_the_withdrawn_target_the_order_is_the_same_and_still_unambiguous(targets: tuple[Target, ...]) -> None:
    order = nearest_first(targets, START)
    first, other = to_withdraw(targets, START)
    assert (first, other) == (order[2].name, order[1].name)
    left = tuple(each for each in targets if each.name != first)
    again = nearest_first(left, START)
    assert again == tuple(each for each in order if each.name != first)
    assert again != left
    assert again != tuple(sorted(left, key=lambda each: math.hypot(each.x - START.x, each.y - START.y)))


def test_nothing_is_withdrawn_from_two_targets() -> None:
    assert to_withdraw(draw_targets(2, START, 1), START) == ()
