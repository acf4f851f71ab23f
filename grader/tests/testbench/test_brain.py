"""The nodes under test behave as described, and each broken node of the course differs from the correct one."""

from __future__ import annotations

import dataclasses

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.kinds import KINDS
from grader.errors import UsageError
from grader.exercise.exercise_toml import parse_tables
from grader.exercise.model import catalogue
from grader.exercise.node_under_test import FIELDS, Behaviour
from grader.exercise.tables import read_toml
from grader.testbench.brain import MOST_NODES, Brain
from grader.testbench.result import LATEST_S, NodeEvents

SECOND = 1_000_000_000
STEP = "12-tests"


def commands(behaviour: Behaviour, *poses: tuple[float, float], after_s: float = 0.1) -> list[dict[str, float] | None]:
    """Return, for each pose, the fields that are not 0 in the command that a node publishes after the pose."""
    brain, found = Brain(behaviour, "wall_guard"), []
    brain.create()
    for number, (x, y) in enumerate(poses or ()):
        brain.pose(0, number * SECOND, x, y)
        values = brain.tick(0, number * SECOND + round(after_s * SECOND))
        found.append(None if values is None else {f: v for f, v in zip(FIELDS, values, strict=True) if v})
    return found


def test_what_happens_to_the_last_node_is_counted() -> None:
    brain = Brain(Behaviour(), "wall_guard")
    assert brain.events() is None
    brain.create()
    brain.tick(0, SECOND)
    brain.create()
    assert brain.events() == NodeEvents(all_calls=1)
    brain.pose(1, SECOND, 5.0, 5.0)
    brain.tick(1, 2 * SECOND)
    assert brain.events() == NodeEvents(poses=1, calls=1, commands=1, first_s=1.0, clock_s=2.0, all_calls=2)
    brain.tick(1, 10 * round(LATEST_S) * SECOND)
    assert brain.events() == NodeEvents(1, 2, 2, 1.0, LATEST_S, 3)


def test_the_right_node_keeps_its_promises() -> None:
    right = Behaviour()
    assert commands(right, (5.0, 5.0), (10.0, 5.0)) == [{"linear.x": 1.0}] * 2
    walls = ((0.9, 5.0), (10.1, 5.0), (5.0, 0.9), (5.0, 10.1))
    assert commands(right, *walls) == [{"linear.x": 0.5, "angular.z": 1.5}] * 4
    assert commands(right, (0.5, 5.0), (5.0, 5.0))[-1] == {"linear.x": 1.0}
    assert commands(right, (5.0, 5.0), after_s=1.0) == [{"linear.x": 1.0}]
    assert commands(right, (5.0, 5.0), after_s=1.1) == [{}]
    brain = Brain(right, "wall_guard")
    brain.create()
    assert brain.tick(0, 0) is None


@pytest.mark.parametrize(
    ("changed", "poses", "expected"),
    [
        ({"publishes": False}, ((5.0, 5.0),), None),
        ({"turns_left": False}, ((0.5, 5.0),), {"linear.x": 0.5, "angular.z": -1.5}),
        ({"turn_field": "angular.x"}, ((0.5, 5.0),), {"linear.x": 0.5, "angular.x": 1.5}),
        ({"walls": ("left", "right")}, ((5.0, 0.5),), {"linear.x": 1.0}),
        ({"straightens": False}, ((0.5, 5.0), (5.0, 5.0)), {"linear.x": 0.5, "angular.z": 1.5}),
    ],
)
def test_a_broken_node_is_broken_in_this_way(
    changed: dict[str, object], poses: tuple[tuple[float, float], ...], expected: object
) -> None:
    assert commands(dataclasses.replace(Behaviour(), **changed), *poses)[-1] == expected  # type: ignore[arg-type]


def test_the_course_has_twelve_different_broken_nodes() -> None:
    spec = find_exercise(STEP).trials[0].tests
    assert spec is not None
    assert len({each.behaviour for each in spec.broken} | {spec.right}) == 13
    caught = {check.params["broken"] for check in find_exercise(STEP).checks if check.kind == "tests_catch"}
    assert caught == {each.id for each in spec.broken}


def test_each_node_has_the_numbers_of_the_student_but_where_it_is_broken() -> None:
    spec = find_exercise(STEP).trials[0].tests
    assert spec is not None
    drawn = spec.with_numbers({"speed_m_s": 0.8, "turn_rad_s": 1.8, "timeout_s": 1.4})
    nodes = {each.id: each.behaviour for each in drawn.broken} | {"right": drawn.right}
    assert {name for name, of in nodes.items() if of.speed_m_s != 0.8} == {"speed"}
    assert {name for name, of in nodes.items() if of.timeout_s != 1.4} == {"stop"}
    assert {of.turn_rad_s for of in nodes.values()} == {1.8}
    assert commands(nodes["sign"], (0.5, 5.0)) == [{"linear.x": 0.5, "angular.z": -1.8}]
    assert len({*nodes.values()}) == 13


def test_a_run_cannot_create_nodes_without_end() -> None:
    brain = Brain(Behaviour(), "wall_guard")
    for _ in range(MOST_NODES + 5):
        last = brain.create()
    assert last["number"] == MOST_NODES - 1
    assert brain.tick(60_000, 0) is None


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("period_s = 0.2", "period_s = 0.1", "this node is the same as the correct node"),
        ("period_s = 0.2", "period = 0.2", "unknown key"),
        ('turn_field = "angular.x"', 'turn_field = "z"', '"turn_field" must be one of'),
        ('walls = ["left", "right"]', 'walls = ["west"]', '"walls" may contain'),
        ("right_runs = 3", "right_runs = 0", '"right_runs" is 0'),
        ("right_runs = 3", "right_runs = 2.5", '"right_runs" is 2.5; it must be a whole number from 1 to 10'),
        ('own = ["speed_m_s"', 'own = ["topic"', '"own" contains topic'),
        ('own = ["speed_m_s"', 'own = ["slow_m_s"', '"own" contains slow_m_s'),
    ],
)
def test_a_mistake_of_the_author_is_told(old: str, new: str, problem: str) -> None:
    file = catalogue()[STEP]
    text = file.read_text("utf-8").replace(old, new)
    with pytest.raises(UsageError, match=problem):
        parse_tables(read_toml(text.encode(), "exercise.toml"), "exercise.toml", file.parent, "", KINDS)
