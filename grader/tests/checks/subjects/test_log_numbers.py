"""Log lines with the right words, of which only some have the right numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.log import LOG_RATE
from grader.tests.checks.made import NODE_FILE, evidence, found, recording, submission
from grader.tests.checks.node_log import LOGS, OTHER_FORM, POINTS, RATE, lines

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


NEARLY = ("x=1.00", "x=1.5", "x=2.5")
OTHERS = 'The format is wrong in 2 of 3 log lines with the right words, for example "x=2.5".'


@pytest.mark.parametrize(
    ("log", "found"),
    [(NEARLY, True), (("x=1.00", "I begin", "I end"), False), (("x=1.00", "x=1.50"), False)],
)
def test_lines_with_other_numbers_are_not_taken_for_missing_lines(log: tuple[str, ...], *, found: bool) -> None:
    given = evidence(recording([], log=lines(*log)), submission({NODE_FILE: LOGS}))
    rate = found_rate(given)
    assert rate.status is Status.FAILED
    assert (rate.observed == OTHERS) == found
    assert (OTHER_FORM in rate.cause) == found


def found_rate(given: Evidence) -> Finding:
    return found(LOG_RATE, given, format=POINTS, **RATE)
