"""The causes that a report states as facts, and the causes that it states as possibilities."""

from __future__ import annotations

import ast
import re
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.certain import FACTS
from grader.checks.diagnoses import DIAGNOSES
from grader.checks.outcome import Finding, Outcome, Status
from grader.report.certainty import cause_label, cause_sentence
from grader.report.github import to_summary
from grader.report.gradescope import to_gradescope
from grader.report.html import html_page
from grader.report.html_notebook import html_fragment
from grader.report.junit import to_junit
from grader.report.report import FURTHER, PASSES, REFUTED
from grader.tests.case import ROOT
from grader.tests.report.reports import EVIDENCE, report

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.report.report import Report

POSSIBILITY = re.compile(r"\b(?:may (?:be|not|never)|might|perhaps|probably|looks? like a|seems)\b", re.IGNORECASE)


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
        (made("node_starts", "needs-stdin"), "why"),
        (made("values", "wrong-sign"), "why"),
        (made("node_starts", "no-spin"), "likely"),
        (made("publishes", "wrong-topic"), "likely"),
        (made("publishes", "wrong-topic", PASSES), "why"),
        (made("publishes", "wrong-topic", f"{FURTHER} After this fix, 1 more mistake appeared."), "why"),
        (made("publishes", "wrong-topic", REFUTED), "likely"),
        (made("kind-of-a-later-version", "wrong-topic"), "likely"),
    ],
)
def test_a_cause_is_a_fact_if_files_an_exception_or_a_try_show_it(outcome: Outcome, label: str) -> None:
    assert cause_label(outcome) == label
    assert cause_sentence(outcome) == ("The reason." if label == "why" else "Likely cause: The reason.")


def test_every_diagnosis_is_a_fact_or_a_possibility_that_a_try_can_confirm() -> None:
    assert set(DIAGNOSES) >= FACTS
    for diagnosis in DIAGNOSES:
        label = "why" if diagnosis in FACTS else "likely"
        assert cause_label(made("publishes", diagnosis)) == label, diagnosis
        assert cause_label(made("publishes", diagnosis, PASSES)) == "why", diagnosis


def texts_of_causes() -> Iterator[tuple[str, str]]:
    """Yield (diagnosis, text) for each Cause(...) in the code of the checks, if the diagnosis is a string literal."""
    for file in sorted((ROOT / "grader/checks").rglob("*.py")):
        for function in (
            each for each in ast.walk(ast.parse(file.read_text("utf-8"))) if isinstance(each, ast.FunctionDef)
        ):
            inside = list(ast.walk(function))
            for call in inside:
                if not (isinstance(call, ast.Call) and ast.unparse(call.func) == "Cause" and len(call.args) > 1):
                    continue
                if not isinstance(call.args[0], ast.Constant):
                    continue
                text = ast.unparse(call.args[1])
                named = [
                    each for each in inside if isinstance(each, ast.Assign) and ast.unparse(each.targets[0]) == text
                ]
                before = [ast.unparse(each.value) for each in named if each.lineno < call.lineno]
                yield str(call.args[0].value), before[-1] if before else text


def test_a_fact_is_not_worded_as_a_possibility() -> None:
    texts = list(texts_of_causes())
    assert any(POSSIBILITY.search(text) for diagnosis, text in texts if diagnosis not in FACTS)
    assert [(diagnosis, text) for diagnosis, text in texts if diagnosis in FACTS and POSSIBILITY.search(text)] == []


def test_each_format_says_which_causes_are_only_likely() -> None:
    def with_try(tried: str) -> Report:
        outcomes = (
            replace(each, finding=replace(each.finding, diagnosis="no-spin", tried=tried))
            if each.status is Status.FAILED
            else each
            for each in report("failed").outcomes
        )
        return replace(report("failed"), outcomes=tuple(outcomes))

    likely, proved = with_try(""), with_try(PASSES)
    cause = next(each.finding.cause for each in likely.outcomes if each.status is Status.FAILED)
    for given, says in ((likely, True), (proved, False)):
        rows = [("anna", given)]
        assert (f"likely: {cause}" in to_junit(rows).decode()) is says
        assert (f"Likely cause: {cause}" in to_gradescope(given)) is says
        assert ("Likely cause" in to_summary(rows)) is says
        assert ("<b>likely:</b>" in html_fragment(EVIDENCE["failed"], given)) is says
        assert ("<dt>Likely cause</dt>" in html_page(EVIDENCE["failed"], given)) is says
