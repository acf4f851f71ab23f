"""Submissions that are right, and unlike ours: full marks, and nothing said against them but advice.

`make test` grades each third, and none of those that live by wall time and take ten seconds.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.tests.case import CASES, read_cases
from grader.tests.gradings import check_clocks_agree, check_report, each

if TYPE_CHECKING:
    from grader.tests.case import Case
    from grader.tests.gradings import Gradings

EVERY = 3
UNUSUAL = tuple(
    replace(case, sample=case.sample and number % EVERY == 0)
    for number, case in enumerate(read_cases(CASES.parent / "unusual"))
)


@pytest.mark.clocks("auto")
@each(UNUSUAL)
def test_what_is_right_gets_full_marks_however_it_is_written(case: Case, gradings: Gradings) -> None:
    assert (case.result, case.points, case.failed, case.skipped) == ("passed", 100, (), ())
    check_report(case, gradings.of(case))


@pytest.mark.exhaustive
@pytest.mark.clocks("auto", "wall")
@each([case for case in UNUSUAL if not case.wall_varies], always=True)
def test_it_is_right_by_the_wall_clock_too(case: Case, gradings: Gradings) -> None:
    check_clocks_agree(case, gradings)
