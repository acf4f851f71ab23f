from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.kinds import KINDS
from grader.errors import UsageError
from grader.exercise.exercise_toml import parse_tables
from grader.exercise.model import Exercise, course_folder
from grader.exercise.own_numbers import NumbersSpec, draw_numbers, from_toml, normal_id, to_toml
from grader.tests.checks.made import every, evidence, recording, submission

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

SPEC = NumbersSpec(
    "07-challenges",
    "my_numbers.toml",
    {"radius_m": (0.8, 1.0, 1.2), "direction": ("clockwise", "counter-clockwise"), "red": (0, 200, 255)},
)


def test_the_same_student_gets_the_same_numbers() -> None:
    assert draw_numbers(SPEC, "ada") == draw_numbers(SPEC, "ada")


def test_students_get_different_numbers() -> None:
    drawn = [draw_numbers(SPEC, f"student {number}") for number in range(200)]
    for name, options in SPEC.options.items():
        assert {each.values[name] for each in drawn} == set(options)


SPELLINGS = [
    "Ada Lovelace",
    "ada lovelace",
    "ADA LOVELACE",
    " Ada  Lovelace\t",
    "\N{FULLWIDTH LATIN CAPITAL LETTER A}da\N{IDEOGRAPHIC SPACE}Lovelace",
    "Ada\u00a0Lovelace",
    "A\N{ZERO WIDTH SPACE}da \N{RIGHT-TO-LEFT OVERRIDE}Lovelace",
    "Ada Lovelace\N{HANGUL FILLER}\N{BRAILLE PATTERN BLANK}",
    "Ada\N{VARIATION SELECTOR-16} Lovelace\x01",
    "Ada Lovelace\N{VARIATION SELECTOR-17}\N{VARIATION SELECTOR-256}",
]


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_every_spelling_of_an_id_draws_the_same_numbers(spelling: str) -> None:
    numbers, wanted = draw_numbers(SPEC, spelling), draw_numbers(SPEC, SPELLINGS[0])
    assert replace(numbers, student="") == replace(wanted, student="")


def test_an_accent_may_be_one_character_or_two_and_other_bytes_count() -> None:
    assert normal_id("zo\u00eb") == normal_id("ZOE\u0308")
    assert normal_id("J\udcf6rg") != normal_id("J\udce4rg")  # names of folders that are not UTF-8


@given(st.text(), st.text())
def test_ids_that_count_as_one_draw_the_same_numbers(one: str, other: str) -> None:
    for spelling in (one.upper(), one.swapcase(), f" {one} ", other):
        if normal_id(spelling) == normal_id(one):
            assert replace(draw_numbers(SPEC, spelling), student="") == replace(draw_numbers(SPEC, one), student="")


@given(st.text())
def test_any_id_survives_the_file(student: str) -> None:
    try:
        student.encode()
    except UnicodeEncodeError:
        return  # a file cannot contain this id
    numbers = draw_numbers(SPEC, student)
    assert from_toml(SPEC, to_toml(numbers).encode()) == numbers


def test_a_byte_of_an_id_that_is_not_utf8_is_left_out_of_the_file() -> None:
    numbers = draw_numbers(SPEC, "ada\udce9")
    assert from_toml(SPEC, to_toml(numbers).encode()) == replace(numbers, student="ada") == draw_numbers(SPEC, "ada")


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("radius_m = ", "cannot be read"),
        ("radius_m = 1.0", "student"),
        ('student = "a"\ndirection = "b"', "radius_m"),
        ('student = "a"\nradius_m = 1.0\ndirection = 3', "direction is missing, or not a string"),
    ],
)
def test_a_broken_file_says_what_is_wrong(text: str, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        from_toml(SPEC, text.encode())


def parsed(numbers: dict[str, object], **check: object) -> Exercise:
    course = tomllib.loads((course_folder() / "03-circle-publisher" / "exercise.toml").read_text("utf-8"))
    circle = next(each for each in course["check"] if each.get("kind") == "circle")
    tables = {**course, "hint": [], "numbers": numbers, "check": [{**circle, "needs": [], **check}]}
    del tables["exercise"]["starting_point_fails"]
    return parse_tables(tables, "exercise.toml", Path(), "", KINDS)


def test_a_parameter_of_a_check_may_be_the_students_own_value() -> None:
    exercise = parsed({"file": "mine.toml", "radius_m": [1.0, 3.0]}, radius_m={"own": "radius_m"})
    assert exercise.numbers is not None
    file = to_toml(draw_numbers(exercise.numbers, "ada")).encode()
    given = evidence(package=submission({"mine.toml": file}), exercise=exercise)
    kind, params = KINDS["circle"], exercise.checks[0].params
    assert kind.radius(given, params) == draw_numbers(exercise.numbers, "ada").values["radius_m"]
    missing = kind.judge(evidence(recording(every(0.5, 1.0, 1.0)), exercise=exercise), params)
    assert missing.diagnosis == "no-numbers"


@pytest.mark.parametrize(
    ("numbers", "own"),
    [
        ({"file": "mine.toml", "radius_m": [1.0, 3.0]}, "diameter_m"),
        ({"file": "mine.toml", "radius_m": [0.0, 3.0]}, "radius_m"),
        ({"file": "mine.toml", "radius_m": ["small", "large"]}, "radius_m"),
        ({"file": "mine.toml", "radius_m": [1.0]}, "radius_m"),
    ],
)
def test_every_own_value_must_fit_the_parameter(numbers: dict[str, object], own: str) -> None:
    with pytest.raises(UsageError, match="radius_m"):
        parsed(numbers, radius_m={"own": own})


@pytest.mark.parametrize("kind", ["own_numbers", "own_rate", "own_circle"])
def test_a_check_of_the_students_numbers_needs_the_table_of_the_numbers(kind: str) -> None:
    course = tomllib.loads((course_folder() / "03-circle-publisher" / "exercise.toml").read_text("utf-8"))
    tables = {**course, "hint": [], "check": [{"id": "own", "kind": kind, "points": 0}]}
    del tables["exercise"]["starting_point_fails"]
    words = rf'the kind "{kind}" needs the table \[numbers\], from which each student gets values.'
    with pytest.raises(UsageError, match=words):
        parse_tables(tables, "exercise.toml", Path(), "", KINDS)
    exercise = parse_tables(
        {**tables, "numbers": {"file": "mine.toml", "a": [1, 2]}}, "exercise.toml", Path(), "", KINDS
    )
    assert exercise.numbers is not None
