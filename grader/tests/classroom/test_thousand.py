"""Grade a mixed class repeatedly, with and without load. All reports must be equal."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.tests.attack import make_attack, read_attacks
from grader.tests.case import make_submission, read_cases
from grader.tests.classroom.a_class import STEP, grade, judged
from grader.tests.grading.test_grade import busy

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.tests.case import Case

CLASS, ROUNDS = 50, 20
TESTS = Path(__file__).parents[1]
AMONG = {"mistakes": 22, "unusual": 11, "cases": 11}
ATTACKS = ("301", "304", "501", "504", "602", "613")


def make_mixed(folder: Path) -> Path:
    """Create a class of step 03 with wrong, correct, unusual and some hostile submissions from all folders of cases."""
    for name, amount in AMONG.items():
        for case in spread(read_cases(TESTS / name), amount):
            make_submission(case, folder / f"{name}-{case.name}")
    for attack in read_attacks():
        if attack.name[:3] in ATTACKS:
            make_attack(attack, folder / f"hostile-{attack.name}")
    return folder


def spread(cases: Sequence[Case], amount: int) -> list[Case]:
    fit = [case for case in cases if (case.exercise or case.base) == STEP and case.result != "usage"]
    return [fit[number * len(fit) // amount] for number in range(amount)]


@pytest.mark.exhaustive
@pytest.mark.timeout(6 * 3600)
def test_a_thousand_gradings_idle_and_under_load_are_equal(tmp_path: Path) -> None:
    (tmp_path / "class").mkdir()
    submitted = make_mixed(tmp_path / "class")
    assert len(list(submitted.iterdir())) == CLASS
    first = None
    for number in range(ROUNDS):
        out = tmp_path / f"grades-{number}"
        with busy(4 if number % 2 else 0):
            done = grade(submitted, "--exercise", STEP, "--out", out)
        assert done.returncode == 0, done.stderr
        found = judged(out)
        first = first or found
        differing = {student: (first[student], found[student]) for student in first if first[student] != found[student]}
        assert differing == {}, f"round {number}"
