"""The display of a run: the estimated time, the submissions in progress, and escaped names."""

from __future__ import annotations

import io
from types import SimpleNamespace

import pytest
from rich.console import Console

from grader.classroom import progress_display
from grader.classroom.progress_display import Lines, Table, estimate, plain, screen, summary
from grader.classroom.results import Result
from grader.tests.report.hostile import ODD
from grader.tests.report.reports import report


def result(student: str, status: str, errors: int = 0) -> Result:
    return Result(student, report(status), {}, "page.html", errors)


@pytest.mark.parametrize(
    ("others", "errors", "suspicious"),
    [
        (["passed"], 2, True),
        (["failed"], 3, True),
        (["passed"], 1, False),
        (["error", "error"], 2, False),
        ([], 2, False),
    ],
)
def test_an_error_that_repeats_while_others_are_judged_is_suspicious(
    others: list[str], errors: int, *, suspicious: bool
) -> None:
    said = summary(
        [*(result(f"other{number}", status) for number, status in enumerate(others)), result("dora", "error", errors)]
    )
    assert ("See dora" in said) == suspicious
    assert (f"{errors} consecutive attempts" in said) == suspicious


@pytest.mark.parametrize(
    ("done", "of", "seconds", "expected"),
    [(0, 10, 5.0, ""), (10, 10, 5.0, ""), (5, 10, 5.0, "about 5 s left"), (10, 200, 30.0, "about 10 min left")],
)
def test_the_estimate_uses_the_average_speed(done: int, of: int, seconds: float, expected: str) -> None:
    assert estimate(done, of, seconds) == expected


@pytest.mark.parametrize("text", ["::error::x", "##[error]x", "###vso[task.x]:::x", ODD, "\n::set-output name=a::b"])
def test_printed_text_controls_neither_terminal_nor_ci(text: str) -> None:
    shown = plain(text)
    assert shown.isprintable()
    assert "::" not in shown
    assert "##" not in shown


def test_a_terminal_shows_submissions_in_progress_and_a_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr(progress_display, "time", SimpleNamespace(monotonic=lambda: now))
    console = Console(file=io.StringIO(), width=140, force_terminal=True, color_system=None)
    table = Table(4, console, several=False)
    table.show(("anna", "03"), "Building with colcon")
    now = 110.0
    table.show(("[red]ben", "03"), "Running 10 s of simulated time")
    table.finished(result("clara", "failed"))
    table.finished(result("dora", "error"))
    now = 112.0
    console.print(table.render())
    assert isinstance(console.file, io.StringIO)
    lines = [line.rstrip() for line in console.file.getvalue().splitlines()]
    assert lines[0].startswith("✗ clara: Not passed yet")
    assert lines[1].startswith("! dora: Not finished")
    assert lines[2].split() == ["anna", "Building", "with", "colcon", "12", "s"]
    assert lines[3].startswith("[red]ben")
    assert lines[3].endswith(" 2 s")
    assert "2 of 4 · 1 not passed · 1 not judged · about 12 s left" in lines[4]


def test_a_pipe_or_a_ci_gets_lines(capsys: pytest.CaptureFixture[str]) -> None:
    with screen(2, several=True) as shown:
        assert isinstance(shown, Lines)
        shown.show(("anna", "03"), "Building")
        shown.finished(result("anna", "passed"))
    exercise = report("passed").exercise
    assert capsys.readouterr().err.startswith(f"[1/2] anna, {exercise}: Passed: ")


def test_the_summary_of_the_class() -> None:
    reported = summary([result("anna", "passed"), result("ben", "failed"), result("clara", "error")])
    assert reported.startswith("3 submissions: 1 passed, 1 not passed, 1 not judged, ")
