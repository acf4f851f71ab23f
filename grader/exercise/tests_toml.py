"""Read the table `[trial.tests]` of exercise.toml: the nodes on which the student's tests run."""

from __future__ import annotations

import re
from dataclasses import fields, replace
from typing import TYPE_CHECKING

from grader.common.words import shorten
from grader.exercise.node_under_test import FIELDS, MESSAGES, WALLS, Behaviour, NodeUnderTest, TestsSpec

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from grader.exercise.model import TrialSpec
    from grader.exercise.own_numbers import NumbersSpec
    from grader.exercise.tables import Table

MODULE = re.compile(r"[a-z]\w*(\.[a-z]\w*)+")
CLASS = re.compile(r"[A-Z]\w*")
ID = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
MAX_RUN_S = 60.0
"""The maximum time of one run of the student's tests (s)."""


def read_tests(table: Table) -> TestsSpec:
    """Return the settings of this trial's tests. Mistakes are recorded in the tables that contain them."""
    tests = table.table("tests")
    duration_s = table.number("duration_s", 1.0, MAX_RUN_S, f"from 1 to {MAX_RUN_S:g} (s)")
    tests.place = f"{table.place}, tests"
    broken = tests.tables("broken")
    for each in broken:
        each.place = f"{tests.place}, {each.place}"
    right = _behaviour(tests.table("right"), Behaviour(), ()) if "right" in tests.values else Behaviour()
    spec = TestsSpec(
        module=tests.string("module", MODULE, "a module, as in my_robot_controller.wall_guard"),
        name=tests.string("class", CLASS, "the name of a class, as in WallGuard"),
        right_runs=tests.whole("right_runs", 1, 10, default=3),
        duration_s=duration_s,
        right=right,
        broken=tuple(_broken(each, right) for each in broken),
        own=tests.strings("own"),
    )
    tests.finish()
    return spec


def unknown_numbers(trials: Sequence[TrialSpec], numbers: NumbersSpec | None) -> Iterator[str]:
    """Yield a message for each name in `own` that is not in `[numbers]` or is not a number of the correct node."""
    options = {} if numbers is None else numbers.options
    for tests in (trial.tests for trial in trials if trial.tests is not None):
        for name in tests.own:
            drawn = options.get(name, ())
            if not drawn or isinstance(drawn[0], str) or not isinstance(getattr(tests.right, name, None), float):
                found = f'[trial.tests]: "own" contains {shorten(name)}'
                yield f"{found}; both a number of the node and a list of numbers in [numbers] must have this name."


def _broken(table: Table, right: Behaviour) -> NodeUnderTest:
    id_ = table.string("id", ID, "lowercase letters, digits and single hyphens, as in wrong-topic")
    behaviour = _behaviour(table, right, ("id",))
    if behaviour == right:
        table.problem("this node is the same as the correct node: change at least one key.")
    return NodeUnderTest(id_, behaviour)


def _behaviour(table: Table, right: Behaviour, known: tuple[str, ...]) -> Behaviour:
    """Return a copy of the behaviour `right` with the changes in this table. Mistakes are recorded in the table."""
    changed: dict[str, object] = {}
    for each in fields(Behaviour):
        if each.name not in table.values:
            continue
        default = getattr(right, each.name)
        if isinstance(default, bool):
            changed[each.name] = table.flag(each.name)
        elif isinstance(default, float):
            changed[each.name] = table.number(each.name, -100.0, 100.0, "a number from -100 to 100")
        elif isinstance(default, tuple):
            changed[each.name] = table.strings(each.name)
        else:
            changed[each.name] = table.string(each.name)
    made = replace(right, **changed)  # type: ignore[arg-type]
    for name, allowed in (("type", MESSAGES), ("speed_field", FIELDS), ("turn_field", FIELDS)):
        if getattr(made, name) not in allowed:
            table.problem(f'"{name}" must be one of {", ".join(allowed)}.')
    if not set(made.walls) <= set(WALLS):
        table.problem(f'"walls" may contain only {", ".join(WALLS)}.')
    if made.period_s <= 0.0:
        table.problem('"period_s" must be greater than 0.')
    table.finish(also=(*known, *(each.name for each in fields(Behaviour))))
    return made
