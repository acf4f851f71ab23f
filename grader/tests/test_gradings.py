"""A case is graded again if other programs kept the machine too busy. Other errors of the grader are not hidden."""

from __future__ import annotations

import os

import pytest

from grader.checks.starved import TOO_BUSY
from grader.tests.gradings import MOST_ATTEMPTS, Graded, higher_priority, until_judged

JUDGED = Graded(0, "", "", {"outcomes": [{"status": "passed"}]})
FAILED = Graded(1, "", "", {"outcomes": [{"status": "failed", "seen": "The turtle did not move."}]})
BUSY = Graded(3, "", "", {"outcomes": [{"status": "error", "seen": TOO_BUSY}]})
IDLE, CROWDED = 0.5, 500.0


@pytest.mark.parametrize(
    ("load", "results", "attempts"),
    [
        (CROWDED, [BUSY, BUSY, JUDGED], 3),
        (CROWDED, [BUSY] * MOST_ATTEMPTS, MOST_ATTEMPTS),
        (CROWDED, [FAILED], 1),
        (CROWDED, [JUDGED], 1),
        (IDLE, [BUSY], 1),
    ],
)
def test_a_case_is_graded_again_while_the_machine_is_too_busy(
    load: float, results: list[Graded], attempts: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "getloadavg", lambda: (load, load, load))
    made: list[Graded] = []

    def attempt() -> Graded:
        made.append(results[len(made)])
        return made[-1]

    assert until_judged(attempt) is results[-1]
    assert len(made) == attempts


def test_the_priority_is_as_before_afterwards() -> None:
    before = os.getpriority(os.PRIO_PROCESS, 0)
    with higher_priority():
        assert os.getpriority(os.PRIO_PROCESS, 0) <= before
    assert os.getpriority(os.PRIO_PROCESS, 0) == before
