"""The page of a submission as text. test_pages_in_browser.py opens pages in a browser."""

from __future__ import annotations

import base64
import hashlib
import json
import re
import subprocess
import sys
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.outcome import Finding, Outcome, Status
from grader.evidence.evidence import Run
from grader.report.escaped_template import with_code
from grader.report.html import html_page, save_html
from grader.report.verdict import verdict
from grader.tests.case import ROOT
from grader.tests.checks.made import NODE, NODE_FILE, every, evidence, good, node, recording, submission
from grader.tests.checks.shapes import SHAPES
from grader.tests.report.hostile import enormous, hostile
from grader.tests.report.reports import EVIDENCE, report_of
from grader.trial.observed import Goal
from grader.trial.recording import Output

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.evidence.evidence import Evidence

LARGEST = 400_000
GIVEN: dict[str, Callable[[], Evidence]] = {
    **{name: lambda given=given: given for name, given in EVIDENCE.items()},  # type: ignore[misc]
    **{name: lambda shape=shape: evidence(shape()) for name, shape in SHAPES.items()},  # type: ignore[misc]
    "hostile": hostile,
    "enormous": enormous,
}
"""Submissions whose pages are made when a test needs them, not when pytest collects the tests."""
VOID = {"meta", "input", "path", "rect", "circle", "ellipse", "polygon", "polyline", "br"}


def page_of(given: Evidence) -> str:
    return html_page(given, report_of(given, submission=given.submission.name))


class Tags(HTMLParser):
    """A parser that collects every element with its attributes, and the contents of script and style."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.texts: dict[str, list[str]] = {}
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        if tag not in VOID:
            assert self.open.pop() == tag, tag

    def handle_data(self, data: str) -> None:
        if self.open:
            self.texts.setdefault(self.open[-1], []).append(data)

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.elements if name == tag]


@pytest.fixture(scope="module", params=GIVEN)
def page(request: pytest.FixtureRequest) -> str:
    return page_of(GIVEN[request.param]())


def test_text_between_backticks_is_code_and_all_of_it_is_escaped() -> None:
    assert with_code("Type `ros2 <b>` & `ls`.") == "Type <code>ros2 &lt;b&gt;</code> &amp; <code>ls</code>."
    assert with_code("a ` <i>") == "a ` &lt;i&gt;"


def test_no_page_shows_the_backticks_of_a_message(page: str) -> None:
    assert not re.search(r'<(dd|span class="observed")>[^<]*`', page)


def test_every_page_is_small_and_closes_its_elements(page: str) -> None:
    assert len(page.encode("utf-8", "replace")) <= LARGEST
    assert Tags(page).open == []


def test_every_page_loads_nothing_and_has_unique_ids(page: str) -> None:
    tags = Tags(page)
    ids = [attributes["id"] for _, attributes in tags.elements if "id" in attributes]
    assert len(ids) == len(set(ids))
    handlers = [
        name for _, attributes in tags.elements for name in attributes if name.startswith("on") or name == "style"
    ]
    assert handlers == []
    addresses = {
        value
        for _, attributes in tags.elements
        for name, value in attributes.items()
        if name in ("src", "href", "action", "srcdoc", "data", "xlink:href")
    }
    assert all(value is not None and value.startswith("#") for value in addresses), addresses
    assert not {"iframe", "img", "object", "embed", "form", "link", "base"} & {tag for tag, _ in tags.elements}


def test_the_policy_allows_only_the_style_and_the_script_of_the_page() -> None:
    page = page_of(EVIDENCE["failed"])
    policy = next(meta["content"] for meta in Tags(page).all("meta") if meta.get("http-equiv"))
    assert policy is not None
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    assert rules["default-src"] == rules["base-uri"] == rules["form-action"] == "'none'"
    for rule, pattern in (("style-src", r"<style>(.*?)</style>"), ("script-src", r"<script>(.*?)</script>")):
        (text,) = re.findall(pattern, page, re.DOTALL)
        assert rules[rule] == f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def test_a_hostile_submission_adds_no_element() -> None:
    tags = Tags(page_of(hostile()))
    assert len(tags.all("script")) == 2
    assert {name for name, _ in tags.elements} <= {name for name, _ in Tags(page_of(EVIDENCE["failed"])).elements} | {
        "strong",
        "em",
    }


def test_unsafe_characters_become_question_marks() -> None:
    page = page_of(hostile())
    assert not set(page) & set("\x00\x1b\x85\u202e\u202c\u2028\ufeff\ud800")


def test_the_page_has_the_checks_of_the_report() -> None:
    given = EVIDENCE["failed"]
    report = report_of(given)
    text = " ".join(Tags(html_page(given, report)).texts["p"])
    assert verdict(report) in text
    texts = [each for of in Tags(html_page(given, report)).texts.values() for each in of]
    for outcome in report.with_status(Status.FAILED):
        finding = outcome.finding
        assert {outcome.title, finding.observed, finding.expected, finding.cause, str(finding.where)} <= {
            each.strip() for each in texts
        }


def test_the_line_of_a_check_is_shown_once_and_marked() -> None:
    given = evidence(SHAPES["radius 2.2"](), node(("linear.x = 2.0", "linear.x = 2.2")))
    page = page_of(given)
    (line,) = re.findall(r'<span class="line marked">(.*?)\n</span>', page, re.DOTALL)
    assert re.sub(r"<.*?>", "", line).split(maxsplit=2)[2] == "msg.linear.x = 2.2"
    assert "This line is shown" in page


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_lines_are_counted_as_python_counts_them(newline: str) -> None:
    code = ("# \x0c a form feed\n" + NODE.replace("linear.x = 2.0", "linear.x = 2.2")).replace("\n", newline)
    page = page_of(evidence(SHAPES["radius 2.2"](), submission({NODE_FILE: code.encode()})))
    (line,) = re.findall(r'<span class="line marked">(.*?)\n</span>', page, re.DOTALL)
    assert "linear.x" in re.sub(r"<.*?>", "", line)


def test_a_hidden_check_shows_only_whether_it_passed() -> None:
    given = EVIDENCE["failed"]
    report = report_of(given)
    secret = Finding(Status.FAILED, "SECRET seen", "SECRET expected", "SECRET cause", "secret", None)
    hidden = (
        Outcome("one", "circle", "SECRET title", 0.0, 7.0, secret, hidden=True),
        Outcome("two", "circle", "SECRET title", 7.0, 7.0, Finding(Status.PASSED, "SECRET"), hidden=True),
    )
    page = html_page(given, replace(report, outcomes=(*report.outcomes, *hidden)))
    assert "SECRET" not in page
    assert page.count("Hidden check") >= 2


def test_numbers_of_a_hidden_check_are_not_drawn() -> None:
    given = EVIDENCE["failed"]
    checks = tuple(replace(spec, hidden=True) for spec in given.exercise.checks)
    page = page_of(replace(given, exercise=replace(given.exercise, checks=checks)))
    assert "required" not in page.lower()
    assert 'class="expected"' not in page


def test_a_fault_of_the_machine_comes_first() -> None:
    page = page_of(EVIDENCE["error"])
    assert page.index("The machine failed, not the submission: The disk is full") < page.index("<h3>")
    assert "12 checks could not be judged. 0 of 100 points so far." in page


def test_logs_with_errors_come_first_and_start_with_the_errors() -> None:
    trace = 'Traceback (most recent call last):\n  File "a.py", line 3\n    x()\nValueError: no\n'
    page = page_of(evidence(recording([], stderr=Output("fine\n" * 30), stdout=Output(f"hello\n{trace}bye\n"))))
    assert page.index('id="log-stdout"') < page.index('id="log-stderr"')
    log = page[page.index('id="log-stdout"') :]
    errors = log[: log.index("The whole log")]
    assert "ValueError: no" in errors
    assert "bye" not in errors
    assert "hello" not in errors


def test_the_player_gets_no_values_that_are_not_finite() -> None:
    given = evidence(recording(every(0.5, 2.0, float("nan"))))
    page = page_of(given)
    data = json.loads(re.findall(r'id="data">(.*?)</script>', page)[0])[0]
    assert len(data["t"]) == len(data["x"]) == len(data["theta"])
    assert data["x"][0] == pytest.approx(5.544)
    assert data["x"][-1] is None
    assert data["commands"][0][2] is None


def test_the_page_has_nothing_that_differs_from_run_to_run() -> None:
    given = evidence(good())
    first, second = (
        html_page(given, report_of(given, seconds={"build": seconds}, recording=path))
        for seconds, path in ((1.0, None), (77.7, "/tmp/rec"))
    )
    assert first == second


def test_the_page_says_what_a_full_recording_left_out() -> None:
    assert "The recording was full" not in page_of(evidence(good()))
    full = replace(good(), dropped=1, interventions_dropped=300, graph_dropped=20)
    reported = "1 message, 300 calls to the simulator&#39;s services and actions and 20 parts of the graph."
    assert f"It does not contain {reported}" in page_of(evidence(full))


def test_each_trial_of_an_exercise_is_shown() -> None:
    whole = find_exercise("07-challenges")
    first, *others = whole.trials
    runs = {first.id: Run(good()), **{trial.id: Run(recording([])) for trial in others}}
    page = page_of(evidence(exercise=whole, runs=runs))
    tags = Tags(page)
    ids = [attributes["id"] for _, attributes in tags.elements if "id" in attributes]
    assert len(ids) == len(set(ids))
    titles = [text.strip() for text in tags.texts["h3"]]
    assert {trial.executable for trial in whole.trials} <= set(titles)
    data = json.loads(re.findall(r'id="data">(.*?)</script>', page)[0])
    assert [len(run["commands"]) > 0 for run in data] == [True, False, False, False]
    assert page.count('class="player"') == len(data) == 4


def test_a_circle_of_another_trial_is_not_drawn() -> None:
    given = EVIDENCE["passed"]
    checks = tuple(replace(spec, trial="other") for spec in given.exercise.checks)
    page = html_page(replace(given, exercise=replace(given.exercise, checks=checks)), report_of(given))
    assert 'class="expected"' not in page
    assert 'class="expected"' in page_of(given)


def test_regrade_makes_the_same_page(tmp_path: Path) -> None:
    grader = str(Path(sys.executable).with_name("grader"))
    solution = "solutions/03-circle-publisher"
    commands = (
        ("check", solution, "--html", str(tmp_path / "1.html"), "--recording", str(tmp_path / "rec"), "--seed", "3"),
        ("regrade", str(tmp_path / "rec"), "--html", str(tmp_path / "2.html")),
    )
    for command in commands:
        done = subprocess.run([grader, *command], cwd=ROOT, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr + done.stdout
    assert (tmp_path / "1.html").read_bytes() == (tmp_path / "2.html").read_bytes()


def test_a_page_that_cannot_be_written_is_a_usage_error(tmp_path: Path) -> None:
    from grader.errors import UsageError

    given = EVIDENCE["passed"]
    with pytest.raises(UsageError, match="cannot be written"):
        save_html(given, report_of(given), tmp_path / "no" / "page.html")


def test_goals_are_in_a_table_and_on_the_time_line_of_the_replay() -> None:
    action, type_ = "/turtle1/rotate_absolute", "turtlesim/action/RotateAbsolute"
    goal = Goal(1.0, action, type_, {"theta": 1.5}, "canceled", {"delta": 0.51234}, 2.5, 1.1, 2.4)
    page = page_of(evidence(recording(every(0.5, 2.0, 1.0), goals=(goal,))))
    cells = ("1.00", "theta=1.5", "canceled", "2.50", "delta=0.512", action)
    labels = ("sent (s)", "goal", "status", "ended (s)", "result", "action")
    row = (f'<td data-label="{label}"><span>{cell}</span></td>' for label, cell in zip(labels, cells, strict=True))
    assert "<tr>" + "".join(row) + "</tr>" in page
    assert "<li>1 goal: 1 canceled</li>" in page
    assert [1.0, f"the node sends a goal to {action}: theta=1.5"] in moments_of(page)
    assert [2.4, f"the node asks {action} to cancel the goal"] in moments_of(page)
    assert [2.5, f"the goal sent to {action} is canceled"] in moments_of(page)


def moments_of(page: str) -> list[list[object]]:
    """Return the texts of the replay with their times (s)."""
    found = re.search(r'"calls": ?(\[.*?\]\])', page)
    assert found is not None
    return list(json.loads(found[1]))
