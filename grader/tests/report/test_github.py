"""A class for GitHub Actions: the summary in Markdown and the annotations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.outcome import Status
from grader.report.github import MOST_ANNOTATIONS, MOST_SUMMARY, to_annotations, to_summary
from grader.tests.report.readers import Command, commands, shown
from grader.tests.report.reports import HOSTILE, hostile_report, report

if TYPE_CHECKING:
    import pytest


def test_the_reader_of_these_tests_knows_both_forms_of_commands() -> None:
    log = "::error file=a.py,line=3,title=a%3A b::it%0Abroke 100%25\nx ##[warning]old\nnone :: here"
    assert commands(log) == [
        Command("error", {"file": "a.py", "line": "3", "title": "a: b"}, "it\nbroke 100%"),
        Command("old warning", {}, "old"),
    ]


def test_an_annotation_has_the_line_and_the_message() -> None:
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


def test_an_error_of_the_machine_is_a_warning() -> None:
    assert {command.name for command in commands(to_annotations([("anna", report("error"))]))} == {"warning"}


def test_text_of_a_student_is_never_a_command() -> None:
    text = to_annotations([(HOSTILE, hostile_report())], "src")
    found = commands(text)
    assert len(found) == min(MOST_ANNOTATIONS, sum(not outcome.advice for outcome in hostile_report().outcomes))
    assert text.count("\n") == len(found)
    assert {command.name for command in found} == {"error"}
    assert all(set(command.properties) == {"title", "file", "line"} for command in found)
    assert "\x1b" not in text


def test_the_summary_is_a_table_with_points() -> None:
    given = report("failed")
    page = shown(to_summary([("anna", given)]))
    assert "anna" in page.cells
    assert f"{given.points:g} of {given.max:g}" in page.cells
    assert {outcome.title for outcome in given.outcomes} <= set(page.cells)


def test_the_summary_has_no_links_images_or_html_of_a_student() -> None:
    summary = to_summary([(HOSTILE, hostile_report())])
    page = shown(summary)
    assert page.elements <= {"table", "thead", "tbody", "tr", "td", "th", "h3"}
    assert page.addresses == []
    assert "@octocat" not in summary
    assert "http://" not in summary
    assert page.cells.count("") + len(page.cells) > 10


def test_the_summary_of_a_large_class_fits_into_one_step() -> None:
    rows = [(f"student{number}", hostile_report()) for number in range(300)]
    summary = to_summary(rows)
    assert len(summary.encode()) < 1024 * 1024
    assert "more submissions do not fit here" in summary
    assert MOST_SUMMARY < 1024 * 1024


def test_a_summary_without_room_for_one_submission_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("grader.report.github.MOST_SUMMARY", 0)
    assert to_summary([("anna", report("failed"))]).endswith("\nThe checks of 1 more submission do not fit here.\n")
