"""Correct submissions that differ from our solutions get full marks. The reports contain no criticism except advice.

`make test` grades at most every fourth submission, and leaves out submissions that need a trial in wall time, since
each takes ten seconds.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.tests.case import CASES, read_cases
from grader.tests.grading_here import all_graded_here
from grader.tests.gradings import check_clocks_agree, check_report, each

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.tests.case import Case
    from grader.tests.grading_here import Grade

EVERY = 4
UNUSUAL = tuple(
    replace(case, sample=case.sample and number % EVERY == 0)
    for number, case in enumerate(read_cases(CASES.parent / "unusual"))
)


@pytest.fixture(scope="module")
def graded(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Grade]:
    yield from all_graded_here(request, tmp_path_factory)


@pytest.mark.parametrize("case", UNUSUAL, ids=lambda case: case.name)
def test_a_case_expects_full_marks(case: Case) -> None:
    assert (case.result, case.points, case.failed, case.skipped) == ("passed", 100, (), ())


@pytest.mark.clocks("auto")
@each(UNUSUAL)
def test_what_is_right_gets_full_marks_however_it_is_written(case: Case, graded: Grade) -> None:
    check_report(case, graded(case, "auto"))


@pytest.mark.exhaustive
@pytest.mark.clocks("auto", "wall")
@each([case for case in UNUSUAL if not case.wall_varies], always=True)
def test_it_is_right_by_the_wall_clock_too(case: Case, graded: Grade) -> None:
    check_clocks_agree(graded(case, "auto"), graded(case, "wall"))
