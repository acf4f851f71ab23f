"""Write the files in the results folder after a run: a page of the class, a table, and files for CI and Gradescope.

    index.html            the page of the class, for the instructor
    summary.csv           for a spreadsheet or gradebook, for the instructor
    junit.xml             for a CI system's list of tests
    gradescope/NAME.json  Gradescope's results.json of each submission
    github-summary.md, github-annotations.txt   for a GitHub Actions step

Students can see the files for CI and Gradescope. For a hidden check, these files contain at most the result
and the points.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.classroom.results import REPORTS
from grader.report.class_reports import ClassReports, Entry
from grader.report.csv import to_csv
from grader.report.github import to_annotations, to_summary
from grader.report.gradescope import to_gradescope
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
    """Write the files. `folder` is the path of the package in a repository. Raises MachineError if the disk fails."""
    from urllib.parse import quote

    from grader.report.html_class import PAGE, class_page  # imports jinja2

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
