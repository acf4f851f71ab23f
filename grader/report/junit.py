"""Reports as JUnit XML for Jenkins, GitLab and others: one test suite per submission, one test case per check.

Students can see this XML. For a hidden check, it contains only the result. A check that only gives advice does not
become a test case.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING

from grader.checks.outcome import Status
from grader.common.words import printable
from grader.report.certainty import cause_label
from grader.report.hidden import for_students
from grader.report.verdict import verdict

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.checks.outcome import Outcome
    from grader.report.report import Report

TAGS = {Status.FAILED: "failure", Status.SKIPPED: "skipped", Status.ERROR: "error"}


def to_junit(rows: Iterable[tuple[str, Report]]) -> bytes:
    """Return the XML for pairs of (student, report)."""
    root = ET.Element("testsuites", name="grader")
    for student, report in rows:
        _suite(root, student, for_students(report))
    for name in ("tests", "failures", "errors", "skipped"):
        root.set(name, str(sum(int(suite.get(name, "0")) for suite in root)))
    root.set("time", f"{sum(float(suite.get('time', '0')) for suite in root):.3f}")
    ET.indent(root)
    text: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return text + b"\n"


def _suite(root: ET.Element, student: str, report: Report) -> None:
    checks = [outcome for outcome in report.outcomes if not outcome.advice]
    counts = {status: sum(outcome.status is status for outcome in checks) for status in TAGS}
    seconds = f"{report.seconds.get('in all', 0.0):.3f}"
    suite = ET.SubElement(
        root,
        "testsuite",
        name=_text(f"{student}: {report.exercise}"),
        tests=str(len(checks)),
        failures=str(counts[Status.FAILED]),
        errors=str(counts[Status.ERROR]),
        skipped=str(counts[Status.SKIPPED]),
        time=seconds,
    )
    properties = ET.SubElement(suite, "properties")
    for name, value in (("points", f"{report.points:g}"), ("max", f"{report.max:g}"), ("verdict", verdict(report))):
        ET.SubElement(properties, "property", name=name, value=_text(value))
    for outcome in checks:
        _case(suite, student, report, outcome)


def _case(suite: ET.Element, student: str, report: Report, outcome: Outcome) -> None:
    # The time of a single check is not known, so it is given as 0. Otherwise, tools might add up wrong times.
    case = ET.SubElement(
        suite, "testcase", name=_text(outcome.title), classname=_text(f"{report.exercise}.{student}"), time="0"
    )
    tag = TAGS.get(outcome.status)
    if tag is None:
        return
    finding = outcome.finding
    element = ET.SubElement(case, tag, message=_text(finding.observed))
    if tag != "skipped":
        element.set("type", _text(finding.diagnosis or tag))
    where = str(finding.where or "")
    rows = (("expected", finding.expected), (cause_label(outcome), finding.cause), ("where", where))
    element.text = "\n".join(_text(f"{label}: {text}") for label, text in rows if text) or None


def _text(text: str) -> str:
    """Replace characters that are not printable, because XML 1.0 cannot represent most of them."""
    return printable(text)
