"""A class as CSV, JUnit, Gradescope's and GitHub's: each read by a reader of that format, with hostile texts in it."""

from __future__ import annotations

import csv
import io
import json
import re
import unicodedata
import xml.etree.ElementTree as ET
from dataclasses import dataclass, replace
from html.parser import HTMLParser
from typing import TYPE_CHECKING, Any

import jsonschema  # type: ignore[import-untyped]
import pytest
from junitparser import Error, Failure, JUnitXml, Skipped, TestCase
from markdown_it import MarkdownIt

from grader.checks.outcome import Finding, Outcome, Status
from grader.report.csv import COLUMNS, to_csv
from grader.report.github import MOST_ANNOTATIONS, MOST_SUMMARY, to_annotations, to_summary
from grader.report.gradescope import to_gradescope
from grader.report.hidden import for_students
from grader.report.html_class import Entry
from grader.report.junit import to_junit
from grader.submission.where import Where
from grader.tests.report.hostile import ALL, ODD
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.report.report import Report

STATUSES = ("passed", "failed", "skipped", "error")
FORMULA = '=HYPERLINK("http://evil.example","click")'
INJECTED = "\r\n::error title=owned::owned\n##[error]owned\n::set-output name=x::y"
MARKDOWN = "![x](http://evil.example/x.png) [y](javascript:alert(1)) <img src=x onerror=alert(1)> `a` | b | @octocat #1"
HOSTILE = f"{FORMULA} {INJECTED} {MARKDOWN} {ALL} {ODD}"


def hostile(status: str = "failed") -> Report:
    """A report in which everything that a student can choose is meant to harm."""
    made = report(status, submission=HOSTILE)
    finding = Finding(Status.FAILED, HOSTILE, HOSTILE, HOSTILE, "a-diagnosis", Where(HOSTILE, 3))
    return replace(made, outcomes=tuple(replace(outcome, finding=finding) for outcome in made.outcomes))


def with_hidden(status: Status) -> Report:
    """A report with one hidden check more."""
    finding = Finding(
        status, "secret seen", "secret expected", "secret cause", "secret-diagnosis", Where("secret.py", 7)
    )
    outcome = Outcome("secret-id", "circle", "secret title", 0.0, 9.0, finding, hidden=True)
    made = report("passed")
    return replace(made, outcomes=(*made.outcomes, outcome))


# CSV


def table(*reports: tuple[str, Report]) -> list[dict[str, str]]:
    text = to_csv(
        (student, each, "0.1.0 abc", f"reports/{number}.json", "") for number, (student, each) in enumerate(reports)
    )
    return list(csv.DictReader(io.StringIO(text.removeprefix("\ufeff"), newline="")))


def test_the_table_has_a_line_a_submission() -> None:
    found = table(*((status, report(status)) for status in STATUSES))
    assert [row["submission"] for row in found] == list(STATUSES)
    assert [row["status"] for row in found] == ["passed", "failed", "failed", "error"]
    assert all(set(row) == set(COLUMNS) for row in found)
    assert float(found[0]["points"]) == report("passed").points
    assert "circle" in found[1]["failed"].split()
    assert "wrong-radius" in found[1]["diagnoses"].split()


def unfinished() -> Report:
    """All that could be judged has passed, and the circle could not be judged: 75 points."""
    made = report("passed")
    broken = Finding(Status.ERROR, "The machine was too busy.")
    outcomes = (replace(each, points=0.0, finding=broken) if each.id == "circle" else each for each in made.outcomes)
    return replace(made, outcomes=tuple(outcomes))


def test_an_error_takes_nothing_out_of_the_maximum_in_any_format() -> None:
    given = unfinished()
    (row,) = table(("anna", given))
    assert (row["points"], row["max"], row["percent"], row["status"]) == ("75", "100", "75.0", "error")
    properties = ET.fromstring(to_junit([("anna", given)])).iter("property")
    assert {each.get("name"): each.get("value") for each in properties}.items() >= {
        "points": "75",
        "max": "100",
    }.items()
    data = gradescope(given)
    circle = next(test for test in data["tests"] if test["name"] == "The turtle drives a circle")
    assert (data["score"], circle["score"], circle["max_score"], circle["status"]) == (75, 0, 25, "failed")
    assert "75 of 100" in shown(to_summary([("anna", given)])).cells
    assert "0/25" in shown(to_summary([("anna", given)])).cells
    assert Entry(given, "anna", "").share == 0.75


SIGNS = ("=", "+", "-", "@", "＝", "＋", "－", "＠", "﹣", "\N{MINUS SIGN}")  # noqa: RUF001 - that is the attack
BEFORE = (
    "",
    " ",
    "\t",
    "\r",
    "\n",
    "\r\n",
    "\N{NO-BREAK SPACE}",
    "\N{IDEOGRAPHIC SPACE}",
    '"',
    "' ",
    "\ufeff",
    "\v",
    "\0",
)
SEPARATORS = (",", ";", "\t", "|")


def begins_like_a_formula(cell: str) -> bool:
    """Whether a spreadsheet may run the cell: blanks are passed over, quotes taken off, wide characters made plain."""
    return unicodedata.normalize("NFKC", cell).lstrip(' \t\r\n"`').startswith(("=", "+", "-", "@", "\N{MINUS SIGN}"))


@pytest.mark.parametrize("sign", SIGNS)
@pytest.mark.parametrize("separator", SEPARATORS)
def test_no_cell_is_a_formula_wherever_a_reader_splits(sign: str, separator: str) -> None:
    call = f"{sign}cmd|' /C calc'!A0"
    names = [f"{before}{call}" for before in BEFORE]
    names += [f"a{between}{before}{call}{between}b" for between in ";|\t" for before in BEFORE]
    text = to_csv((name, hostile(), "0.1.0 abc", f"{name}.json", name) for name in names).removeprefix("\ufeff")
    rows = list(csv.reader(io.StringIO(text, newline=""), delimiter=separator))
    rows += [line.split(separator) for line in text.split("\r\n")]  # a reader that knows no quotes
    cells = [cell for row in rows for cell in row]
    assert len(cells) > len(names)
    assert [cell for cell in cells if begins_like_a_formula(cell)] == []
    assert all(cell.isprintable() for cell in text.split("\r\n"))


# JUnit


def junit(*reports: tuple[str, Report]) -> JUnitXml:
    return JUnitXml.fromstring(to_junit(reports))


def cases(xml: JUnitXml) -> Iterator[TestCase]:
    for suite in xml:
        yield from suite


def test_junit_has_a_suite_a_submission_and_a_case_a_check() -> None:
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


def test_a_failure_tells_what_was_seen() -> None:
    case = next(
        case for case in cases(junit(("anna", report("failed")))) if isinstance(case.result[:1], list) and case.result
    )
    failure = case.result[0]
    outcome = next(each for each in report("failed").outcomes if each.status is Status.FAILED)
    assert (failure.message, failure.type) == (outcome.finding.observed, outcome.finding.diagnosis)
    assert outcome.finding.expected in failure.text


def test_junit_is_xml_whatever_a_student_wrote() -> None:
    xml = junit((HOSTILE, hostile()))
    assert len(list(cases(xml))) == sum(not outcome.advice for outcome in hostile().outcomes)


# Gradescope: the keys of "Autograder Specifications", "Output Format", with the values that they may have.

VISIBILITY = {"enum": ["hidden", "after_due_date", "after_published", "visible"]}
FORMAT = {"enum": ["text", "html", "simple_format", "md", "ansi"]}
RESULTS: dict[str, Any] = {
    "type": "object",
    "additionalProperties": False,
    "properties": {
        "score": {"type": "number"},
        "execution_time": {"type": "number"},
        "output": {"type": "string"},
        "output_format": FORMAT,
        "test_output_format": FORMAT,
        "test_name_format": FORMAT,
        "visibility": VISIBILITY,
        "stdout_visibility": VISIBILITY,
        "extra_data": {"type": "object"},
        "leaderboard": {"type": "array"},
        "tests": {
            "type": "array",
            "items": {
                "type": "object",
                "additionalProperties": False,
                "dependentRequired": {"max_score": ["score"]},
                "properties": {
                    "score": {"type": "number"},
                    "max_score": {"type": "number", "minimum": 0},
                    "status": {"enum": ["passed", "failed"]},
                    "name": {"type": "string"},
                    "name_format": FORMAT,
                    "number": {"type": "string"},
                    "output": {"type": "string"},
                    "output_format": FORMAT,
                    "tags": {"type": "array", "items": {"type": "string"}},
                    "visibility": VISIBILITY,
                    "extra_data": {"type": "object"},
                },
            },
        },
    },
    "anyOf": [{"required": ["score"]}, {"properties": {"tests": {"items": {"required": ["score"]}}}}],
}


def gradescope(given: Report) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(to_gradescope(given))
    jsonschema.validate(data, RESULTS)
    return data


@pytest.mark.parametrize("status", STATUSES)
def test_gradescope_gets_the_keys_it_knows(status: str) -> None:
    given = report(status)
    data = gradescope(given)
    assert data["score"] == pytest.approx(given.points)
    assert sum(test.get("score", 0) for test in data["tests"]) == pytest.approx(given.points)
    assert sum(test.get("max_score", 0) for test in data["tests"]) == pytest.approx(given.max)
    assert [test["name"] for test in data["tests"]] == [outcome.title for outcome in given.outcomes]


def test_gradescope_shows_hostile_text_as_text() -> None:
    data = gradescope(hostile())
    assert {test["output_format"] for test in data["tests"]} == {data["output_format"]} == {"text"}
    assert all(line.isprintable() for test in data["tests"] for line in test["output"].split("\n"))


# GitHub: as the runner reads commands ("Workflow commands for GitHub Actions"; ActionCommand.cs of actions/runner).


@dataclass(frozen=True)
class Command:
    name: str
    properties: dict[str, str]
    message: str


def commands(log: str) -> list[Command]:
    """Every command in a log, of both forms."""
    found = []
    for line in re.split(r"\r\n|\r|\n", log):
        new = re.match(r"\s*::([^\s:]+)(?: ([^:]*(?::(?!:)[^:]*)*?))?::(.*)$", line)
        if new:
            pairs = [pair.partition("=") for pair in (new[2] or "").split(",") if pair]
            properties = {name: unescaped(value, more=True) for name, _, value in pairs}
            found.append(Command(new[1], properties, unescaped(new[3])))
        elif old := re.search(r"##\[([^\]]+)\](.*)$", line):
            found.append(Command(f"old {old[1]}", {}, old[2]))
    return found


def unescaped(text: str, *, more: bool = False) -> str:
    signs = {"%0D": "\r", "%0A": "\n", **({"%3A": ":", "%2C": ","} if more else {}), "%25": "%"}
    return re.sub("|".join(signs), lambda match: signs[match[0]], text)


def test_the_reader_of_commands_reads_both_forms() -> None:
    log = "::error file=a.py,line=3,title=a%3A b::it%0Abroke 100%25\nx ##[warning]old\nnone :: here"
    assert commands(log) == [
        Command("error", {"file": "a.py", "line": "3", "title": "a: b"}, "it\nbroke 100%"),
        Command("old warning", {}, "old"),
    ]


def test_annotations_name_the_line_and_what_was_seen() -> None:
    given = report("failed")
    found = commands(to_annotations([("anna", given)], "exercises/03/my_robot_controller"))
    failed = given.with_status(Status.FAILED)
    assert [command.name for command in found] == ["error"] * len(failed)
    for command, outcome in zip(found, failed, strict=True):
        assert command.properties["title"] == f"anna: {outcome.title}"
        assert outcome.finding.observed in command.message
        if outcome.finding.where and outcome.finding.where.line:
            assert command.properties["line"] == str(outcome.finding.where.line)
            assert command.properties["file"] == f"exercises/03/my_robot_controller/{outcome.finding.where.file}"


def test_what_the_machine_failed_at_is_a_warning() -> None:
    assert {command.name for command in commands(to_annotations([("anna", report("error"))]))} == {"warning"}


def test_no_command_of_a_students_is_run() -> None:
    text = to_annotations([(HOSTILE, hostile())], "src")
    found = commands(text)
    assert len(found) == min(MOST_ANNOTATIONS, sum(not outcome.advice for outcome in hostile().outcomes))
    assert text.count("\n") == len(found)
    assert {command.name for command in found} == {"error"}
    assert all(set(command.properties) == {"title", "file", "line"} for command in found)
    assert "\x1b" not in text


class Elements(HTMLParser):
    """The elements of a page, the addresses that it leads to, and its text."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.elements: set[str] = set()
        self.addresses: list[str] = []
        self.cells: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.add(tag)
        self.addresses += [value or "" for name, value in attrs if name in ("href", "src")]
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_data(self, data: str) -> None:
        if self.cells:
            self.cells[-1] = (self.cells[-1] + data).strip()


def shown(markdown: str) -> Elements:
    """The Markdown as GitHub's flavour has it: tables, HTML let through, bare addresses made into links."""
    return Elements(MarkdownIt("gfm-like", {"html": True, "linkify": False}).render(markdown))


def test_the_summary_is_a_table_with_the_points() -> None:
    given = report("failed")
    page = shown(to_summary([("anna", given)]))
    assert "anna" in page.cells
    assert f"{given.points:g} of {given.max:g}" in page.cells
    assert {outcome.title for outcome in given.outcomes} <= set(page.cells)


def test_nothing_in_the_summary_acts() -> None:
    summary = to_summary([(HOSTILE, hostile())])
    page = shown(summary)
    assert page.elements <= {"table", "thead", "tbody", "tr", "td", "th", "h3"}
    assert page.addresses == []
    assert "@octocat" not in summary
    assert "http://" not in summary
    assert page.cells.count("") + len(page.cells) > 10


def test_a_large_class_fits_into_a_step() -> None:
    rows = [(f"student{number}", hostile()) for number in range(300)]
    summary = to_summary(rows)
    assert len(summary.encode()) < 1024 * 1024
    assert "more submissions are left out here" in summary
    assert MOST_SUMMARY < 1024 * 1024


# What is hidden


@pytest.mark.parametrize("status", list(Status))
def test_of_a_hidden_check_students_see_whether_it_passed(status: Status) -> None:
    given = with_hidden(status)
    rows = [("anna", given)]
    texts = {
        "junit": to_junit(rows).decode(),
        "gradescope": to_gradescope(given),
        "summary": to_summary(rows),
        "annotations": to_annotations(rows, "src"),
    }
    assert [name for name, text in texts.items() if "secret" in text] == []
    said = {Status.PASSED: "passed", Status.ERROR: "could not be judged"}.get(status, "failed")
    assert for_students(given).outcomes[-1].finding.observed == f"Hidden check: {said}."
    assert for_students(given).points == given.points
    assert for_students(given).max == given.max
