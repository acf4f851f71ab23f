from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.exercise.own_numbers import DIRECTIONS, RADII_M, RATES_HZ, draw_numbers, from_toml, normal_id, to_toml


def test_the_same_student_gets_the_same_numbers() -> None:
    assert draw_numbers("ada") == draw_numbers("ada")


def test_students_get_different_numbers() -> None:
    drawn = [draw_numbers(f"student {number}") for number in range(200)]
    assert {each.radius_m for each in drawn} == set(RADII_M)
    assert {each.rate_hz for each in drawn} == set(RATES_HZ)
    assert {each.direction for each in drawn} == set(DIRECTIONS)


SPELLINGS = [
    "Ada Lovelace",
    "ada lovelace",
    "ADA LOVELACE",
    " Ada  Lovelace\t",
    "\N{FULLWIDTH LATIN CAPITAL LETTER A}da\N{IDEOGRAPHIC SPACE}Lovelace",
    "Ada\u00a0Lovelace",
]


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_every_spelling_of_an_id_draws_the_same_numbers(spelling: str) -> None:
    numbers, wanted = draw_numbers(spelling), draw_numbers(SPELLINGS[0])
    assert replace(numbers, student="") == replace(wanted, student="")


@given(st.text(), st.text())
def test_ids_that_count_as_one_draw_the_same_numbers(one: str, other: str) -> None:
    for spelling in (one.upper(), one.swapcase(), f" {one} ", other):
        if normal_id(spelling) == normal_id(one):
            assert replace(draw_numbers(spelling), student="") == replace(draw_numbers(one), student="")


@given(st.text())
def test_any_id_survives_the_file(student: str) -> None:
    try:
        student.encode()
    except UnicodeEncodeError:
        return  # (no file can hold it, nor can a terminal give it)
    numbers = draw_numbers(student)
    assert from_toml(to_toml(numbers).encode()) == numbers


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("radius_m = ", "cannot be read"),
        ("radius_m = 1.0", "student or direction"),
        ('student = "a"\ndirection = "b"', "radius_m"),
    ],
)
def test_a_broken_file_says_what_is_wrong(text: str, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        from_toml(text.encode())
