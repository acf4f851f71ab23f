"""docs/kinds.md shows every kind of check as defined in the code, with examples that an author can copy."""

from __future__ import annotations

import sys
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import pytest

from grader.authoring.console_blocks import blocks
from grader.authoring.kinds_page import UNITS, main, page, unit_of
from grader.checks.exercises import load_exercise
from grader.checks.kinds import KINDS
from grader.exercise.model import catalogue, course_folder
from grader.exercise.own_numbers import Own

if TYPE_CHECKING:
    from pathlib import Path

    from grader.checks.kind import Kind

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

WITHOUT_UNIT = {
    "turns",
    "turtles",
    "total",
    "sides",
    "first",
    "nth",
    "goes_on",
    "red",
    "green",
    "blue",
    "at_least",
    "at_most",
    "value",
}
"""Numeric parameters that have no unit, or that have the same unit as another parameter or a field."""


def sections() -> dict[str, str]:
    """Map each kind of check to its section of the page."""
    parts = page().split("\n### ")[1:]
    return {part.partition("\n")[0]: part.partition("\n## ")[0] for part in parts}


def numbers_of(kind: Kind[Any]) -> list[str]:
    return [each.name for each in fields(kind.params) if each.type == "float"]


def test_the_page_is_up_to_date() -> None:
    assert main(["--check"]) == 0


def test_a_page_that_is_out_of_date_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "docs").mkdir()
    monkeypatch.setattr("grader.authoring.kinds_page.course_folder", lambda: tmp_path / "course")
    assert main(["--check"]) == 1
    assert main([]) == 0
    assert main(["--check"]) == 0
    written = tmp_path / "docs/kinds.md"
    written.write_text(written.read_text("utf-8") + "\n", "utf-8")
    assert main(["--check"]) == 1
    assert (course_folder().parent / "docs/kinds.md").read_text("utf-8") == page()


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS.keys())
def test_a_kind_is_described_with_every_parameter(kind: Kind[Any]) -> None:
    section = sections()[kind.name]
    assert kind.about in section
    assert kind.about.endswith(".")
    assert kind.title in section
    for name, allowed in kind.parameters().items():
        default = kind.defaults().get(name)
        row = next(line for line in section.splitlines() if line.startswith(f"| `{name}` |")).split(" | ")
        assert allowed.about.endswith(".")
        assert row[-1] == f"{allowed.about} |"
        assert row[-2] == allowed.words
        assert (row[2] == "required") == (name not in kind.defaults())
        if isinstance(default, float):
            assert float(row[2].strip("`")) == default


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS.keys())
def test_a_number_has_a_unit(kind: Kind[Any]) -> None:
    assert [name for name in numbers_of(kind) if not unit_of(name) and name not in WITHOUT_UNIT] == []


def test_units_are_read_from_names() -> None:
    assert [unit_of(name) for name in ("linear_x_m_s", "angular_z_rad_s", "radius_m", "within_s", "turns")] == [
        "m/s",
        "rad/s",
        "m",
        "s",
        "",
    ]
    assert len(set(UNITS.values())) == len(UNITS)


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS.keys())
def test_the_example_is_a_check_of_the_course(kind: Kind[Any]) -> None:
    example = next(block for block in blocks(sections()[kind.name]) if block.language == "toml")
    check = tomllib.loads(example.text)["check"][0]
    assert check.pop("kind") == kind.name
    exercises = (load_exercise(file) for file in catalogue().values())
    exercise, spec = next((each, spec) for each in exercises for spec in each.checks if spec.kind == kind.name)
    assert check.pop("id") == spec.id
    assert check.pop("points") == spec.points
    assert check.pop("title", kind.title) == spec.title
    assert tuple(check.pop("needs", ())) == spec.needs
    assert check.pop("trial", exercise.trials[0].id) == spec.trial
    own = with_own(check)
    given = {
        name: value if isinstance(value, Own) else kind.parameters()[name].accept(value) for name, value in own.items()
    }
    assert {**kind.defaults(), **given} == spec.params


def with_own(table: dict[str, Any]) -> dict[str, Any]:
    """Return the table with an Own in place of each value `{ own = "name" }`, also in tables inside the table."""
    return {
        name: value
        if not isinstance(value, dict)
        else Own(value["own"])
        if value.keys() == {"own"}
        else with_own(value)
        for name, value in table.items()
    }
