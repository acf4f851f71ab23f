"""For every case in cases/, the grader writes the expected report."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.tests.case import read_cases
from grader.tests.gradings import check_clocks_agree, check_report, each

if TYPE_CHECKING:
    from grader.tests.case import Case
    from grader.tests.gradings import Gradings

CASES = read_cases()


@pytest.mark.clocks("auto")
@each(CASES)
def test_a_case_gets_the_report_that_it_expects(case: Case, gradings: Gradings) -> None:
    check_report(case, gradings.of(case))


@pytest.mark.exhaustive
@pytest.mark.clocks("auto", "wall")
@each([case for case in CASES if case.result != "usage" and not case.wall_varies], always=True)
def test_both_clocks_agree(case: Case, gradings: Gradings) -> None:
    check_clocks_agree(gradings.of(case, "auto"), gradings.of(case, "wall"))
