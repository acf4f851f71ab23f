"""Every mistake in mistakes/ is called by its name, at its place, in words that a beginner understands."""

from __future__ import annotations

import os
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TYPE_CHECKING

import pytest

from grader.tests.case import CASES, Case, read_cases
from grader.tests.grading import Graded, check_report, each
from grader.tests.grading_here import Builds, grade_here

if TYPE_CHECKING:
    from collections.abc import Iterator

MISTAKES = read_cases(CASES.parent / "mistakes")


@pytest.fixture(scope="module")
def graded(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[dict[str, Future[Graded]]]:
    """Every case that is asked for, graded side by side: name -> what was said."""
    folder, builds = tmp_path_factory.mktemp("mistakes"), Builds()
    items = [item for item in request.session.items if item.path == request.path]
    cases = {
        item.callspec.params["case"].name: item.callspec.params["case"] for item in items if hasattr(item, "callspec")
    }
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        yield {name: pool.submit(grade_here, case, "auto", folder / name, builds) for name, case in cases.items()}
        pool.shutdown(cancel_futures=True)


@each(MISTAKES, always=True)
def test_a_mistake_is_named(case: Case, graded: dict[str, Future[Graded]]) -> None:
    check_report(case, graded[case.name].result())
