"""A task in which students draw a circle with their own radius and direction."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.outcome import Status
from grader.checks.subjects.own import CIRCLE, NUMBERS, RATE
from grader.evidence.evidence import Run
from grader.exercise.own_numbers import draw_numbers, to_toml
from grader.tests.checks.made import every, evidence, exercise, found, recording, submission
from grader.tests.checks.told import told

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.exercise.own_numbers import OwnNumbers

STEP = find_exercise("07")
assert STEP.numbers is not None
SPEC = STEP.numbers
FILE = SPEC.file
ALICE = draw_numbers(SPEC, "alice")
RADIUS_M, RATE_HZ = float(ALICE.values["radius_m"]), float(ALICE.values["rate_hz"])
SIDE = {"counter-clockwise": 1.0, "clockwise": -1.0}


def changed(**values: float) -> OwnNumbers:
    """Return alice's numbers, some of which are replaced by these values."""
    return replace(ALICE, values={**ALICE.values, **values})


def given(numbers: OwnNumbers | str | None, by: str | None = "alice") -> Evidence:
    """Return the evidence of a circle that was driven with alice's numbers, and of a file with the given numbers."""
    commands = every(1.0 / RATE_HZ, RADIUS_M, SIDE[str(ALICE.values["direction"])])
    text = numbers if numbers is None or isinstance(numbers, str) else to_toml(numbers)
    return evidence(
        recording(commands), replace(submission({FILE: text}), student=by), exercise=replace(exercise(), numbers=SPEC)
    )


@pytest.mark.parametrize("by", ["alice", " Alice", "alice\udce9", None])
def test_the_own_numbers_pass_whoever_may_write_the_name_otherwise(by: str | None) -> None:
    assert found(NUMBERS, given(ALICE, by)).status is Status.PASSED


def test_no_spelling_of_the_own_id_makes_a_friends_circle_pass() -> None:
    """Bob submits Alice's program, and tries spellings of his own id until a spelling gives him Alice's numbers."""
    for number in range(512):
        spelling = "".join(char.upper() if number >> at & 1 else char for at, char in enumerate("bobbobbob"))
        numbers = draw_numbers(SPEC, spelling)
        assert found(NUMBERS, given(numbers, "bobbobbob")).status is Status.PASSED
        assert Status.FAILED in {found(kind, given(numbers, "bobbobbob")).status for kind in (CIRCLE, RATE)}


@pytest.mark.parametrize(
    ("numbers", "by", "diagnosis", "observed"),
    [
        (
            ALICE,
            "bob",
            "numbers-of-another",
            f'The numbers in {FILE} were assigned to "alice", but "bob" submitted them.',
        ),
        (
            changed(radius_m=RADIUS_M + 0.2),
            "alice",
            "numbers-changed",
            f"The numbers in {FILE} are not the ones that were assigned to this student.",
        ),
        (None, "alice", "no-numbers", f"There is no {FILE}."),
        ("student = 3", "alice", "numbers-unreadable", f"{FILE}: student is missing, or not a string."),
    ],
)
def test_other_numbers_are_reported_from_the_own(
    numbers: OwnNumbers | str | None, by: str, diagnosis: str, observed: str
) -> None:
    finding = found(NUMBERS, given(numbers, by))
    assert (finding.status, finding.diagnosis, finding.observed) == (Status.FAILED, diagnosis, observed)
    assert str(finding.where) == ("None" if numbers is None else FILE)


def test_the_trajectory_is_judged_by_the_numbers_drawn_whatever_the_file_says() -> None:
    other = given(changed(radius_m=RADIUS_M + 0.4, rate_hz=10.0))
    assert [found(kind, other).status for kind in (CIRCLE, RATE)] == [Status.PASSED] * 2


@pytest.mark.parametrize(("student", "diagnosis"), [("bob", "wrong-direction"), ("carol", "wrong-radius")])
def test_a_trajectory_by_somebody_elses_numbers_is_wrong(student: str, diagnosis: str) -> None:
    other = given(draw_numbers(SPEC, student), by=None)
    assert [found(kind, other).diagnosis for kind in (CIRCLE, RATE)] == [diagnosis, "wrong-rate"]


@pytest.mark.parametrize(
    ("share", "status"), [(1.2, Status.PASSED), (1.4, Status.FAILED), (0.85, Status.PASSED), (0.75, Status.FAILED)]
)
def test_one_interval_may_be_a_little_longer_or_shorter_than_the_own_period(share: float, status: Status) -> None:
    period_s = 1.0 / RATE_HZ
    commands = every(period_s, RADIUS_M, 1.0)
    moved = [(t_s + (share - 1.0) * period_s * (index >= 20), v, w) for index, (t_s, v, w) in enumerate(commands)]
    assert found(RATE, given(ALICE).with_run(Run(recording(moved)))).status is status


@pytest.mark.parametrize(("first_s", "diagnosis"), [(2.9, None), (3.5, "late-start")])
def test_the_first_command_may_come_three_seconds_late(first_s: float, diagnosis: str | None) -> None:
    commands = every(1.0 / RATE_HZ, RADIUS_M, 1.0, first_s=first_s)
    assert found(RATE, given(ALICE).with_run(Run(recording(commands)))).diagnosis == diagnosis


def test_without_numbers_there_is_nothing_to_judge_the_trajectory_by() -> None:
    assert [found(kind, given(None)).diagnosis for kind in (CIRCLE, RATE)] == ["no-numbers"] * 2


def test_an_id_with_a_space_is_quoted_in_the_command() -> None:
    assert "--student 'Bob B' --fresh`" in found(NUMBERS, given(ALICE, "Bob B")).cause


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("Every student has their own numbers.", (ALICE, "bob"), (ALICE, "alice")),
        (
            "`grader start 07 --student bob --fresh` draws your numbers and moves your work to another folder.",
            (ALICE, "bob"),
            (changed(radius_m=RADIUS_M + 0.2), "alice"),
        ),
        (
            "Do not change the file. Use the file's numbers in your node.",
            (changed(radius_m=RADIUS_M + 0.2), "alice"),
            (ALICE, "bob"),
        ),
    ],
)
def test_a_sentence_about_the_numbers_is_true(
    words: str, true: tuple[OwnNumbers, str], near: tuple[OwnNumbers, str]
) -> None:
    assert words in told(found(NUMBERS, given(*true)))
    assert words not in told(found(NUMBERS, given(*near)))
