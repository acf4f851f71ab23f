"""Choose random places for targets, which are turtles that a node must catch, nearest first.

Places are drawn again until the order of the targets is unambiguous. If a turtle always goes to the nearest target,
only one order must be possible. With three or more targets, two other rules (by name, by the distance from the start)
must lead to a different order. All this must also be true without the target that the trial may withdraw.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.trial.recording import Pose

NAMES = ("ada", "bela", "cleo", "dora", "emil")
LOW_M, HIGH_M = 1.5, 9.5
"""The smallest and the largest coordinate that a target can have (m)."""
APART_M = 1.6
"""The minimum distance between two targets, and between a target and the start (m)."""
CLEAR_M = 1.2
"""The minimum difference between the distances to the nearest and to the second-nearest target (m)."""
LONGEST_M = 20.0
"""The maximum length of the path from the start through all targets (m)."""
MOST_DRAWS = 20_000


@dataclass(frozen=True)
class Target:
    """A turtle with its name and its place (m)."""

    name: str
    x: float
    y: float


def draw_targets(count: int, start: Pose, seed: int) -> tuple[Target, ...]:
    """Return `count` targets, sorted by name.

    Places are drawn, at most MOST_DRAWS times, until the order of the targets is unambiguous (see the beginning of this
    module) and the distances satisfy APART_M, CLEAR_M and LONGEST_M.
    """
    draw = random.Random(f"targets {seed}")
    targets: tuple[Target, ...] = ()
    for _ in range(MOST_DRAWS):
        targets = tuple(
            Target(name, round(draw.uniform(LOW_M, HIGH_M), 2), round(draw.uniform(LOW_M, HIGH_M), 2))
            for name in NAMES[:count]
        )
        if _is_clear(targets, start):
            break
    return targets


def nearest_first(targets: tuple[Target, ...], start: Pose) -> tuple[Target, ...]:
    """Return the targets in the order in which a turtle reaches them if it always goes to the nearest target."""
    order: list[Target] = []
    x, y = start.x, start.y
    left = list(targets)
    while left:
        left.sort(key=lambda each: math.hypot(each.x - x, each.y - y))
        order.append(left.pop(0))
        x, y = order[-1].x, order[-1].y
    return tuple(order)


def to_withdraw(targets: tuple[Target, ...], start: Pose) -> tuple[str, ...]:
    """Return the names of two targets: after the first catch, the trial withdraws the first of them that is not caught.

    A node that does not forget a withdrawn target drives to it, since other targets are farther away. Return no names
    if there are fewer than three targets.
    """
    order = nearest_first(targets, start)
    return tuple(each.name for each in order[2:0:-1]) if len(order) > 2 else ()


def _is_clear(targets: tuple[Target, ...], start: Pose) -> bool:
    names = to_withdraw(targets, start)
    if not names:
        return _is_unambiguous(targets, start)
    left = tuple(each for each in targets if each.name != names[0])
    order = tuple(each for each in nearest_first(targets, start) if each in left)
    both = _is_unambiguous(targets, start) and _is_unambiguous(left, start)
    return both and nearest_first(left, start) == order


def _is_unambiguous(targets: tuple[Target, ...], start: Pose) -> bool:
    order = nearest_first(targets, start)
    x, y = start.x, start.y
    way_m = 0.0
    for number, target in enumerate(order):
        to_m = math.hypot(target.x - x, target.y - y)
        others_m = [math.hypot(each.x - x, each.y - y) for each in order[number + 1 :]]
        if to_m < APART_M or any(each < to_m + CLEAR_M for each in others_m):
            return False
        way_m += to_m
        x, y = target.x, target.y
    by_start = sorted(targets, key=lambda each: math.hypot(each.x - start.x, each.y - start.y))
    other_rules = len(order) < 3 or (order != targets and order != tuple(by_start))
    return way_m <= LONGEST_M and other_rules
