"""Everything about a kind of check is defined in one place."""

from __future__ import annotations

import pkgutil
import subprocess
from importlib import import_module

from grader.checks import subjects
from grader.checks.exercises import find_exercise
from grader.checks.kind import Kind
from grader.checks.kinds import KINDS
from grader.common.interpreter import interpreter
from grader.tests.checks.made import evidence


def test_each_kind_is_listed_under_its_own_name() -> None:
    modules = [
        import_module(f"{subjects.__name__}.{module.name}") for module in pkgutil.iter_modules(subjects.__path__)
    ]
    defined = [each for module in modules for each in vars(module).values() if isinstance(each, Kind)]
    assert {name: kind.name for name, kind in KINDS.items()} == {kind.name: kind.name for kind in defined}
    assert "no such kind" not in KINDS
    assert KINDS.get("no such kind") is None


def test_an_exercise_imports_only_the_kinds_that_it_uses() -> None:
    start = interpreter(
        "-c",
        "import sys; from grader.checks.exercises import find_exercise; find_exercise('01');"
        "print(*(name in sys.modules for name in ('grader.checks.subjects.log', 'grader.checks.subjects.star')))",
    )
    assert subprocess.check_output(start.argv, env=start.env, text=True) == "True False\n"


def test_a_drawn_start_leaves_room_for_the_circle_of_the_check() -> None:
    requested = {
        spec.id: KINDS[spec.kind].radius(evidence(), spec.params) for spec in find_exercise("07-challenges").checks
    }
    # The radius of a student's circle depends on the student's id. There is room for it at every start.
    assert {id_: radius for id_, radius in requested.items() if radius is not None} == {"eight": 1.0}
    circle = next(spec for spec in find_exercise("03").checks if spec.id == "circle")
    assert KINDS[circle.kind].radius(evidence(), {**circle.params, "radius_m": 3.25}) == 3.25


def test_what_is_drawn_of_a_kind_is_what_a_node_must_drive_for() -> None:
    drawn = {name for name, kind in KINDS.items() if kind.requested is not None}
    assert drawn == {"circle", "own_circle", "figure_eight", "square", "goal", "star", "rate", "values"}
    assert {name for name, kind in KINDS.items() if kind.drives} == drawn | {"own_rate", "arc", "pause", "catches_all"}
