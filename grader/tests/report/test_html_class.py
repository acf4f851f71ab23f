"""The page of a class, made from a folder of reports."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.errors import UsageError
from grader.report.class_reports import ClassReports, Entry, read_class
from grader.report.hidden import for_students
from grader.report.html import html_page
from grader.report.html_class import class_page, counts, failures, save_class_page
from grader.report.json import MOST_OUTCOMES, from_json, to_data, to_json
from grader.tests.report.hostile import ALL, SCRIPTS
from grader.tests.report.reports import EVIDENCE, report
from grader.tests.report.test_html import Tags

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with seven reports: three passed, two failed, one not built, and one that could not be judged."""
    for number, status in enumerate(("passed", "passed", "passed", "failed", "failed", "skipped", "error")):
        given = report(status, submission=f"class/student{number}/step")
        (tmp_path / f"student{number}").mkdir()
        (tmp_path / f"student{number}" / "report.json").write_text(to_json(given), "utf-8")
    (tmp_path / "student1" / "report.html").write_text("its page")
    return tmp_path


def test_a_report_is_named_by_the_part_of_its_path_that_differs(folder: Path) -> None:
    assert [entry.name for entry in read_class(folder).entries] == [f"student{number}" for number in range(7)]


def test_a_report_with_a_page_next_to_it_is_linked(folder: Path) -> None:
    links = {entry.name: entry.link for entry in read_class(folder).entries}
    assert links["student1"] == "./student1/report.html"
    assert links["student2"] == ""


def test_the_most_frequent_failures_come_first_with_causes(folder: Path) -> None:
    found = failures(entry for entry in read_class(folder).entries if entry.tone != "error")
    amounts = [len(check.entries) for check in found]
    assert amounts == sorted(amounts, reverse=True)
    circle = next(check for check in found if check.id == "circle")
    assert [(each.id, len(each.entries)) for each in circle.diagnoses] == [("wrong-radius", 2)]
    assert "linear.x divided by angular.z" in circle.diagnoses[0].text


def test_the_change_that_confirmed_a_cause_is_for_instructors_only(folder: Path) -> None:
    given = report("failed")
    change = "-        msg.linear.x = 2.2\n+        msg.linear.x = <2.0>\n"
    given = replace(
        given,
        outcomes=tuple(
            replace(each, finding=replace(each.finding, change=change)) if each.id == "circle" else each
            for each in given.outcomes
        ),
    )
    assert from_json(to_json(given)) == given
    assert not any(each.finding.change for each in for_students(given).outcomes)
    assert "2.0&gt;" not in html_page(EVIDENCE["failed"], given)
    (folder / "proved.json").write_text(to_json(replace(given, submission="zoe/my_robot_controller")))
    page = class_page(read_class(folder))
    assert page.count("The change that confirmed the cause") == 1
    assert "msg.linear.x = &lt;2.0&gt;" in page


def test_the_median_of_two_is_the_mean_of_both() -> None:
    entries = tuple(Entry(report(status), status, "") for status in ("passed", "failed"))
    middle = 50 * sum(entry.share for entry in entries)
    assert f"median {middle:.0f} %" in class_page(ClassReports(entries, ()))


def test_errors_of_the_machine_have_their_own_list_and_do_not_count_in_averages(folder: Path) -> None:
    tags = Tags(class_page(read_class(folder)))
    page = class_page(read_class(folder))
    table = page[page.index("<tbody>") : page.index("</tbody>")]
    verdict = '<td data-label="verdict"><span><span class="mark error" aria-hidden="true">!</span> not judged'
    assert f"0 of 100</td>\n{verdict}" in table
    assert table.count("<tr ") == 7
    assert "student6" in page[page.index('id="machine"') :]
    assert "The disk is full" in page[page.index('id="machine"') :]
    assert any("6 submissions judged: 3 passed, 3 not yet" in text for text in tags.texts["p"])


def test_a_class_without_a_judged_submission_has_no_averages() -> None:
    page = class_page(ClassReports((Entry(report("error"), "anna", ""),), ()))
    assert "<title>Class: 1 submission</title>" in page
    assert "No submission was judged." in page
    assert "On average" not in page


def test_a_submission_that_ends_with_an_error_repeatedly_is_listed(folder: Path) -> None:
    assert 'id="attention"' not in class_page(read_class(folder))
    file = folder / "student6" / "report.json"
    file.write_text(json.dumps({**json.loads(file.read_text()), "errors": 2}))
    page = class_page(read_class(folder))
    attention = page[page.index('id="attention"') :]
    assert "student6" in attention
    assert "suspicious: it could not be judged in 2 consecutive attempts, but other submissions could" in attention


def test_other_files_are_ignored_and_damaged_reports_are_listed(folder: Path) -> None:
    (folder / "results.json").write_text('{"tests": []}')
    (folder / "damaged.json").write_text('{"schema": 1, "outcomes": [{}]}')
    (folder / "later.json").write_text(json.dumps({**to_data(report("passed")), "schema": 99}))
    reports = read_class(folder)
    assert len(reports.entries) == 7
    assert [name for name, _ in reports.left_out] == ["damaged.json", "later.json"]
    assert "schema 99" in class_page(reports)


@pytest.mark.parametrize(("points", "most"), [(-1e9, 10.0), (1e9, 10.0), (10.0, 0.0)])
def test_a_report_with_impossible_points_does_not_prevent_the_page(folder: Path, points: float, most: float) -> None:
    data = to_data(report("passed"))
    data["outcomes"][0].update(points=points, max=most)
    (folder / "forged.json").write_text(json.dumps(data))
    reports = read_class(folder)
    assert len(reports.entries) == 7
    assert [name for name, _ in reports.left_out] == ["forged.json"]
    assert f"{points} of {most} points" in class_page(reports)


def test_a_report_with_thousands_of_outcomes_is_listed_and_not_read(folder: Path) -> None:
    data = to_data(report("failed"))
    data["outcomes"] = data["outcomes"][:1] * (MOST_OUTCOMES + 1)
    (folder / "long.json").write_text(json.dumps(data))
    assert [name for name, _ in read_class(folder).left_out] == ["long.json"]


@pytest.mark.parametrize("share", [0.0, 0.09999999, 0.1, 0.5, 0.899999, 0.9, 0.999, 1.0])
def test_each_bar_counts_the_submissions_in_its_range(share: float) -> None:
    found = counts([share])
    assert found.index(1) == int(share * 10)
    assert sum(found) == 1


def test_all_points_have_a_bar_of_their_own() -> None:
    assert counts([1.0, 0.99])[-2:] == [1, 1]


def test_a_hostile_name_adds_no_element_and_no_link(folder: Path) -> None:
    plain = {name for name, _ in Tags(class_page(read_class(folder))).elements}
    hostile = report("failed", submission=f"class/{ALL}/step")
    wicked = tuple(
        replace(
            outcome, title=ALL, id=ALL, finding=replace(outcome.finding, observed=ALL, cause=ALL, diagnosis=SCRIPTS[0])
        )
        for outcome in hostile.outcomes
    )
    for name in ("javascript:pwned(1)", '" onmouseover=pwned(2) x="', "<script>pwned(3)<"):
        (folder / f"{name}.json").write_text(to_json(replace(hostile, outcomes=wicked)), "utf-8")
        (folder / f"{name}.html").write_text("")
    tags = Tags(class_page(read_class(folder)))
    assert {name for name, _ in tags.elements} == plain
    assert all((link["href"] or "").startswith(("#", "./")) for link in tags.all("a"))
    assert not [name for _, attributes in tags.elements for name in attributes if name.startswith("on")]


def test_no_name_of_an_exercise_turns_the_text_around(folder: Path) -> None:
    """Nobody checks the exercise in a report file, and the character U+202E reverses the text that follows."""
    for status in ("failed", "error"):
        odd = replace(report(status, submission=f"class/{status}/step"), exercise="03-\u202eelcric\x1b[31m")
        (folder / f"{status}.json").write_text(to_json(odd), "utf-8")
    texts = Tags(class_page(read_class(folder))).texts
    visible = "".join(text for name, parts in texts.items() if name not in ("script", "style") for text in parts)
    assert visible.count("03-?elcric") >= 4
    assert not {"\u202e", "\x1b"} & set(visible)


def test_a_folder_without_reports_is_a_usage_error(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="There is no report below"):
        read_class(tmp_path)
    with pytest.raises(UsageError, match="There is no folder"):
        read_class(tmp_path / "no")


def test_the_page_of_several_exercises_has_an_exercise_column(folder: Path) -> None:
    other = replace(report("failed", submission="class/student0/other"), exercise="04-pose-subscriber")
    (folder / "other.json").write_text(to_json(other), "utf-8")
    save_class_page(folder, folder / "index.html")
    page = (folder / "index.html").read_text("utf-8")
    assert '<th scope="col" data-sort="text">exercise</th>' in page
    assert 'value="04-pose-subscriber/circle"' in page
    assert 'value="03-circle-publisher/circle"' in page
