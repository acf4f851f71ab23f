"""A class as JUnit XML, read by junitparser."""

from __future__ import annotations

from typing import TYPE_CHECKING

from junitparser import Error, Failure, JUnitXml, Skipped, TestCase

from grader.checks.outcome import Status
from grader.report.junit import to_junit
from grader.tests.report.reports import HOSTILE, STATUSES, hostile_report, report

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.report.report import Report


def junit(*reports: tuple[str, Report]) -> JUnitXml:
    return JUnitXml.fromstring(to_junit(reports))


def cases(xml: JUnitXml) -> Iterator[TestCase]:
    for suite in xml:
        yield from suite


def test_junit_has_one_suite_per_submission_and_one_case_per_check() -> None:
    rows = [(status, report(status)) for status in STATUSES]
    xml = junit(*rows)
    assert [suite.name for suite in xml] == [f"{status}: {report(status).exercise}" for status in STATUSES]
    for suite, (_, given) in zip(xml, rows, strict=True):
        checks = [outcome for outcome in given.outcomes if not outcome.advice]
        assert [case.name for case in suite] == [outcome.title for outcome in checks]
        kinds = {Status.FAILED: Failure, Status.SKIPPED: Skipped, Status.ERROR: Error}
        for case, outcome in zip(suite, checks, strict=True):
            assert [type(each) for each in case.result] == [kinds[s] for s in kinds if s is outcome.status]
        counted = (suite.tests, suite.failures, suite.skipped, suite.errors)
        suite.update_statistics()  # type: ignore[no-untyped-call]
        assert counted == (suite.tests, suite.failures, suite.skipped, suite.errors)


def test_a_failure_has_the_message_and_the_diagnosis() -> None:
    case = next(
        case for case in cases(junit(("anna", report("failed")))) if isinstance(case.result[:1], list) and case.result
    )
    failure = case.result[0]
    outcome = next(each for each in report("failed").outcomes if each.status is Status.FAILED)
    assert (failure.message, failure.type) == (outcome.finding.observed, outcome.finding.diagnosis)
    assert outcome.finding.expected in failure.text


def test_hostile_text_does_not_break_the_xml() -> None:
    xml = junit((HOSTILE, hostile_report()))
    assert len(list(cases(xml))) == sum(not outcome.advice for outcome in hostile_report().outcomes)
