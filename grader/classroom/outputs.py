"""What stands in the folder of results when a run is through: the class as a page, as a table, for CI and Gradescope.

    index.html            the class page, for the instructor
    summary.csv           for a spreadsheet or gradebook, for the instructor
    junit.xml             for a CI's list of tests
    gradescope/NAME.json  Gradescope's results.json of each submission
    github-summary.md, github-annotations.txt   for a step of GitHub Actions

Students may see the files for CI and Gradescope: what is hidden is left out of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.classroom.results import REPORTS
from grader.report.csv import to_csv
from grader.report.github import to_annotations, to_summary
from grader.report.gradescope import to_gradescope
from grader.report.html_class import PAGE, ClassReports, Entry, class_page
from grader.report.junit import to_junit
from grader.report.suspicion import suspicions

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.classroom.results import Result, Results

SUMMARY = "summary.csv"
JUNIT = "junit.xml"
GRADESCOPE = "gradescope"
GITHUB_SUMMARY = "github-summary.md"
GITHUB_ANNOTATIONS = "github-annotations.txt"


def write_all(results: Results, graded: Sequence[Result], folder: str = "") -> None:
    """Write them; `folder` is where the package is in a repository. Raises MachineError where the disk forbids it."""
    from urllib.parse import quote

    rows = [(result.student, result.report) for result in graded]
    attention = suspicions([(result.report, result.errors) for result in graded])
    table = [
        (result.student, result.report, str(result.key["grader"]), f"{REPORTS}/{_json(result)}", why)
        for result, why in zip(graded, attention, strict=True)
    ]
    entries = [
        Entry(result.report, result.student, f"./{REPORTS}/{quote(result.page)}", why)
        for result, why in zip(graded, attention, strict=True)
    ]
    results.write(SUMMARY, to_csv(table).encode("utf-8", "replace"))
    results.write(JUNIT, to_junit(rows))
    for result in graded:
        results.write(f"{GRADESCOPE}/{_json(result)}", to_gradescope(result.report).encode("utf-8", "replace"))
    results.write(GITHUB_SUMMARY, to_summary(rows).encode("utf-8", "replace"))
    results.write(GITHUB_ANNOTATIONS, to_annotations(rows, folder).encode("utf-8", "replace"))
    results.write(PAGE, class_page(ClassReports(tuple(entries), ())).encode("utf-8", "replace"))


def _json(result: Result) -> str:
    return result.page.removesuffix(".html") + ".json"
