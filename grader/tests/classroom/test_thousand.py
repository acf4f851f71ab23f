"""A mixed class graded again and again, idle and under load: no report differs."""

from __future__ import annotations

import subprocess
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from grader.tests.attack import make_attack, read_attacks
from grader.tests.case import make_submission, read_cases
from grader.tests.classroom.a_class import STEP, grade, judged

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

CLASS, ROUNDS = 50, 20
ATTACKS = ("301", "304", "501", "504", "602", "613")


@contextmanager
def load(loops: int) -> Iterator[None]:
    children = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(loops)]
    try:
        yield
    finally:
        for child in children:
            child.kill()
            child.wait()


def make_mixed(folder: Path) -> Path:
    """Cases of step 03, every kind of mistake, with hostile submissions among them."""
    attacks = [attack for attack in read_attacks() if attack.name[:3] in ATTACKS]
    cases = [case for case in read_cases() if case.base == STEP and case.give == "." and case.result != "usage"]
    wanted = CLASS - len(attacks)
    step = len(cases) / wanted
    for case in {cases[int(number * step)].name: cases[int(number * step)] for number in range(wanted)}.values():
        make_submission(case, folder / case.name)
    for attack in attacks:
        make_attack(attack, folder / f"hostile-{attack.name}")
    return folder


@pytest.mark.exhaustive
@pytest.mark.timeout(6 * 3600)
def test_a_thousand_gradings_idle_and_under_load_are_one(tmp_path: Path) -> None:
    (tmp_path / "class").mkdir()
    submitted = make_mixed(tmp_path / "class")
    assert len(list(submitted.iterdir())) == CLASS
    first = None
    for number in range(ROUNDS):
        out = tmp_path / f"grades-{number}"
        with load(4 if number % 2 else 0):
            done = grade(submitted, "--exercise", STEP, "--out", out)
        assert done.returncode == 0, done.stderr
        found = judged(out)
        first = first or found
        differing = {student: (first[student], found[student]) for student in first if first[student] != found[student]}
        assert differing == {}, f"round {number}"
