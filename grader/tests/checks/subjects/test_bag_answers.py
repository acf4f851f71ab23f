"""Answers about the student's bag: numbers with their units."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.tests import made_bag
from grader.tests.checks.bag_step import judged
from grader.tests.checks.told import told

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    ("check", "answer", "diagnosis"),
    [
        ("duration", '"11.1 s"', None),
        ("duration", '"11.12s"', None),
        ("duration", '"11.1"', "unit-missing"),
        ("duration", '"11.1 m"', "wrong-unit"),
        ("duration", '"11123267399 s"', "nanoseconds"),
        ("duration", '"13 s"', "wrong-answer"),
        ("duration", '"long"', "answer-form"),
        ("rate", '"0.016 Hz"', "period-for-rate"),
        ("rate", '"62.50 Hz"', None),
        ("rate", '"62.57 Hz"', "rate-off-by-one"),
        ("rate", '"62.7 Hz"', "wrong-answer"),
        ("radius", '"2.2 m"', "diameter"),
        ("messages", "696", None),
        ("messages", '"696"', None),
        ("messages", "695", "wrong-answer"),
        ("messages", "0", "no-answer"),
    ],
)
def test_an_answer_is_a_number_with_its_unit(check: str, answer: str, diagnosis: str | None) -> None:
    files = {"answers.toml": f"[answers]\n{check} = {answer}\n".encode()}
    assert judged(check, files=files).diagnosis == diagnosis


def about(check: str, answer: str) -> str:
    return told(judged(check, files={"answers.toml": f"[answers]\n{check} = {answer}\n".encode()}))


@pytest.mark.parametrize(
    ("words", "check", "true", "near"),
    [
        ("11.1 s is right.", "duration", '"11.1 s"', '"12.1 s"'),
        ("duration is not answered yet.", "duration", '""', "true"),
        ("messages is not answered yet.", "messages", "0", "1"),
        ("duration is neither a string nor a number.", "duration", "true", '""'),
        ('duration is a number and its unit, s, as in "12.5 s".', "duration", '"long"', '"11.1 s"'),
        ('messages is a number, as in "1250".', "messages", '"many"', "696"),
        ("duration is [11.1 s].", "duration", '["11.1 s"]', '"11.1 s"'),
        ("Write the number without a comma.", "messages", '"1,234"', '"many"'),
        ("Write a dot, not a comma, in decimal numbers.", "duration", '"11,1 s"', '"long"'),
        ("A number needs its unit.", "duration", '"11.1"', '"11.1 m"'),
        ("The unit is s.", "duration", '"11.1 m"', '"11.1"'),
        ("A count has no unit.", "messages", '"696 m"', '"696"'),
        ("The answer is the value in your bag.", "duration", '"13 s"', '"11.1 s"'),
        ("Time stamps in a bag are in nanoseconds.", "duration", '"11123267399 s"', '"1112326739 s"'),
        ("This is the period, the time between two messages", "rate", '"0.016 Hz"', '"0.032 Hz"'),
        ("This is the number of messages divided by the duration.", "rate", '"62.57 Hz"', '"62.7 Hz"'),
        ("n messages have only n - 1 intervals.", "rate", '"62.57 Hz"', '"62.39 Hz"'),
        ("This is the diameter, twice the radius.", "radius", '"2.2 m"', '"3.3 m"'),
        (
            "`ros2 bag info` shows the duration of a bag. Does the answer come from an earlier bag?",
            "duration",
            '"13 s"',
            '"11.1 s"',
        ),
    ],
)
def test_a_sentence_about_an_answer_is_true(words: str, check: str, true: str, near: str) -> None:
    assert words in about(check, true)
    assert words not in about(check, near)


@pytest.mark.parametrize(("check", "of_bag"), [("duration", True), ("radius", False)])
def test_a_bag_has_a_duration_but_no_radius(check: str, *, of_bag: bool) -> None:
    given = about(check, '"77 s"' if of_bag else '"77 m"')
    assert ("`ros2 bag info` shows the duration of a bag." in given) == of_bag
    assert ("If your own program prints this value for this bag, the program is wrong." in given) != of_bag


@pytest.mark.parametrize(("answer", "is_told"), [(2, True), (3, False)])
def test_a_count_of_all_messages_is_told(answer: int, tmp_path: Path, *, is_told: bool) -> None:
    made_bag.record(tmp_path / "circle_bag", [*made_bag.poses()[:1], *made_bag.commands(0.1)])
    files = {f"circle_bag/{file.name}": file.read_bytes() for file in (tmp_path / "circle_bag").iterdir()}
    files["answers.toml"] = f"[answers]\nmessages = {answer}\n".encode()
    given = told(judged("messages", files=files))
    assert ("Only the messages on the topic with the poses count." in given) == is_told
