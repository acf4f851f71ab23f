"""The causes that a report states as facts, and the causes that it states as possibilities."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.outcome import Finding, Outcome, Status
from grader.report.certainty import cause_label, cause_sentence
from grader.report.github import to_summary
from grader.report.gradescope import to_gradescope
from grader.report.html import html_page
from grader.report.html_notebook import html_fragment
from grader.report.junit import to_junit
from grader.report.report import FURTHER, PASSES, REFUTED
from grader.tests.report.reports import EVIDENCE, report


def made(kind: str, diagnosis: str, tried: str = "") -> Outcome:
    finding = Finding(Status.FAILED, "seen", "expected", "The reason.", diagnosis, tried=tried)
    return Outcome("check", kind, "title", 0.0, 1.0, finding)


@pytest.mark.parametrize(
    ("outcome", "label"),
    [
        (made("dependencies", "missing-depend"), "why"),
        (made("builds", "setup-py-syntax"), "why"),
        (made("node_starts", "missing-import"), "why"),
        (made("node_starts", "crash"), "why"),
        (made("node_starts", "no-spin"), "likely"),
        (made("publishes", "wrong-topic"), "likely"),
        (made("publishes", "wrong-topic", PASSES), "why"),
        (made("publishes", "wrong-topic", f"{FURTHER} Then 1 more mistake appeared."), "why"),
        (made("publishes", "wrong-topic", REFUTED), "likely"),
        (made("kind-of-a-later-version", "wrong-topic"), "likely"),
    ],
)
def test_a_cause_is_a_fact_if_files_an_exception_or_a_try_show_it(outcome: Outcome, label: str) -> None:
    assert cause_label(outcome) == label
    assert cause_sentence(outcome) == ("The reason." if label == "why" else "Likely cause: The reason.")


def test_each_format_says_which_causes_are_only_likely() -> None:
    likely, proved = report("failed"), report("failed")
    proved = replace(
        proved,
        outcomes=tuple(
            replace(each, finding=replace(each.finding, tried=PASSES)) if each.status is Status.FAILED else each
            for each in proved.outcomes
        ),
    )
    cause = next(each.finding.cause for each in likely.outcomes if each.status is Status.FAILED)
    for given, says in ((likely, True), (proved, False)):
        rows = [("anna", given)]
        assert (f"likely: {cause}" in to_junit(rows).decode()) is says
        assert (f"Likely cause: {cause}" in to_gradescope(given)) is says
        assert ("Likely cause" in to_summary(rows)) is says
        assert ("<b>likely:</b>" in html_fragment(EVIDENCE["failed"], given)) is says
        assert ("<dt>Likely cause</dt>" in html_page(EVIDENCE["failed"], given)) is says
