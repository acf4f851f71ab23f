"""Every mistake in mistakes/ gets its diagnosis with the correct file and line, in words for a beginner."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.diagnoses import DIAGNOSES
from grader.checks.exercises import find_exercise
from grader.checks.judge import judge_early
from grader.evidence.evidence import Evidence
from grader.exercise.model import catalogue
from grader.submission.package import open_submission
from grader.tests.case import BASES, ROOT, Case, base_of, make_submission, read_cases
from grader.tests.catalogue import MISTAKES, PAGE, SHOWN_BY_TESTS, TESTS, amounts, cases, page
from grader.tests.grading_here import all_graded_here
from grader.tests.gradings import Graded, check_clocks_agree, check_report, each, place_of
from grader.tests.sample import sample, shows, without_test

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from grader.tests.grading_here import Grade

ALL = read_cases(MISTAKES)
SAMPLE = sample(ALL)
CASES = tuple(replace(case, sample=case.name in SAMPLE) for case in ALL)
JUDGED = [case for case in CASES if case.result != "usage"]
MOST_SAMPLE = 40
"""The maximum number of cases in the sample. With more cases, `make test` would take too long."""
MOST_WORDS = 60
FEWEST = 15
"""The minimum number of mistakes of a step that a report names."""
FEWEST_UNUSUAL = 3
MOST_CASES = 12
"""The maximum number of cases for one diagnosis. Some rules can be broken in many ways."""
SAID_BY_RCLPY = "rclpy.init() has not been called"
"""A message of rclpy that a report quotes."""
LONG = 12
"""The minimum length of a line (characters). A shorter line of a solution, such as `pass`, does not give the solution
away."""
NOWHERE = frozenset({"node-name", "no-answers", "no-bag", "no-numbers", "rejected-file"})
"""A report with one of these diagnoses need not refer to a file."""


@pytest.fixture(scope="module")
def graded(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Grade]:
    yield from all_graded_here(request, tmp_path_factory)


@pytest.mark.clocks("auto")
@each(CASES)
def test_a_mistake_is_named(case: Case, graded: Grade) -> None:
    check_report(case, graded(case, "auto"))


@pytest.mark.clocks("auto")
@each(JUDGED)
def test_what_is_said_is_short_and_whole(case: Case, graded: Grade) -> None:
    for outcome in failures(graded(case, "auto")):
        assert outcome["seen"], outcome
        assert outcome["expected"], outcome
        assert place_of(outcome) or outcome["diagnosis"] in NOWHERE, outcome
        assert len(text_of(outcome).split()) <= MOST_WORDS, outcome
        assert outcome["diagnosis"] in DIAGNOSES, outcome


@pytest.mark.clocks("auto")
@each(JUDGED)
def test_what_is_said_gives_nothing_away(case: Case, graded: Grade, tmp_path: Path) -> None:
    given = make_submission(case, tmp_path / "given")
    own = "\n".join(path.read_text("utf-8", "replace") for path in given.rglob("*") if path.is_file())
    for outcome in failures(graded(case, "auto")):
        text = text_of(outcome).replace(SAID_BY_RCLPY, "")
        assert [line for line in solution_lines() if line in text and line not in own] == []


@pytest.mark.exhaustive
@pytest.mark.clocks("auto", "wall")
@each([case for case in JUDGED if not case.wall_varies], always=True)
def test_both_clocks_name_the_same_mistake(case: Case, graded: Grade) -> None:
    check_clocks_agree(graded(case, "auto"), graded(case, "wall"))


def test_a_diagnosis_is_not_shown_over_and_over() -> None:
    """A case counts for the first diagnosis that it names."""
    of_here = [case for case in CASES if case.is_of_this_rclpy]
    about = Counter(next(iter(case.diagnosis.values())) for case in of_here if case.diagnosis)
    assert [id_ for id_, amount in about.items() if amount > MOST_CASES] == []


def test_there_is_enough_to_learn_from() -> None:
    assert len(CASES) >= 120
    assert len([case for case in CASES if (base := base_of(case)) is None or base.parent == BASES]) >= 40
    assert {find_exercise(case.exercise or case.base).id for case in CASES} >= set(catalogue())


def test_each_step_has_enough_cases() -> None:
    few = {id_ for id_, (mistakes, _, unusual) in amounts().items() if mistakes < FEWEST or unusual < FEWEST_UNUSUAL}
    assert few == set()


def test_every_diagnosis_is_shown_by_a_case_or_a_test() -> None:
    by_case = {id_ for case in cases() for id_ in case.diagnosis.values()}
    assert sorted(DIAGNOSES.keys() - by_case - SHOWN_BY_TESTS.keys()) == []
    assert sorted(by_case - DIAGNOSES.keys()) == []
    assert sorted(by_case & SHOWN_BY_TESTS.keys()) == [], "the case is enough"


def test_the_sample_shows_each_group_of_diagnoses_and_each_exercise() -> None:
    shown = frozenset[object]().union(*(shows(case) for case in CASES if case.sample))
    assert shown == frozenset[object]().union(*map(shows, CASES))
    assert without_test() <= shown
    assert len(SAMPLE) <= MOST_SAMPLE


@pytest.mark.parametrize(("id_", "file"), SHOWN_BY_TESTS.items())
def test_a_test_that_shows_a_diagnosis_expects_it_by_its_id(id_: str, file: str) -> None:
    assert f'"{id_}"' in (TESTS / file).read_text("utf-8")


def test_the_authors_page_is_up_to_date() -> None:
    assert PAGE.read_text("utf-8") == page(), "python -m grader.tests.catalogue makes it anew"


@pytest.mark.parametrize(
    ("name", "reported"),
    [
        ("122", ["entry-point"]),
        ("305", ["build"]),
        ("306", ["dependencies"]),
        ("403", ["depends-geometry-msgs"]),
        ("453", ["build"]),
        ("101", []),
    ],
)
def test_what_the_files_alone_tell_is_known_before_anything_runs(
    name: str, reported: list[str], tmp_path: Path
) -> None:
    case = next(case for case in CASES if case.name.startswith(name))
    submission = open_submission(make_submission(case, tmp_path / "in"))
    early = judge_early(Evidence(find_exercise(case.exercise or case.base), submission))
    assert [outcome.id for outcome in early.failed] == reported


def failures(of: Graded) -> list[dict[str, Any]]:
    return [outcome for outcome in of.outcomes().values() if outcome["status"] == "failed"]


def text_of(outcome: dict[str, Any]) -> str:
    return " ".join(str(outcome[key]) for key in ("seen", "expected", "cause"))


@cache
def solution_lines() -> frozenset[str]:
    """Return the lines in all solutions that a student has to write."""
    found: set[str] = set()
    for path in sorted((ROOT / "solutions").rglob("*")):
        if path.is_file() and path.suffix in (".py", ".xml", ".toml", ".cfg"):
            inside = False
            for line in path.read_text("utf-8").splitlines():
                if "BEGIN SOLUTION" in line or "END SOLUTION" in line:
                    inside = "BEGIN" in line
                elif inside and len(line.strip()) >= LONG:
                    found.add(line.strip())
    assert found
    return frozenset(found)
