from __future__ import annotations

import dataclasses
import io
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from grader.checks.cause import Cause
from grader.checks.outcome import Status, failed, passed
from grader.report.terminal import HIDDEN, SAME, render
from grader.report.verdict import UNCONFINED, UNKNOWN
from grader.submission.where import Where
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from grader.report.report import Report

ESCAPE = "\x1b"


class Latin1(io.StringIO):
    """A stream that can encode only a few characters, as on an old terminal."""

    encoding = "latin-1"


def reported(
    made: Report,
    *,
    width: int = 80,
    terminal: bool = False,
    stream: io.StringIO | None = None,
    verbose: bool = False,
) -> str:
    file = stream or io.StringIO()
    console = Console(file=file, width=width, force_terminal=terminal, color_system="truecolor" if terminal else None)
    render(made, console, verbose=verbose)
    return file.getvalue()


def test_a_pipe_gets_no_escape_sequences_and_no_wrapping() -> None:
    text = reported(report("failed"), width=30)
    assert ESCAPE not in text
    assert "    seen: All 19 commands were wrong: linear.x 2.2 m/s.\n" in text


def test_the_verdict_comes_last() -> None:
    lines = reported(report("failed")).splitlines()
    assert lines[0] == "Draw a circle: alice/my_robot_controller"
    assert lines[-1] == "Not passed yet: 55 of 100 points, 2 checks failed."


def test_simulated_time_is_printed_on_request_and_wall_time_always() -> None:
    simulated = report("failed")
    assert "Judged in" not in reported(simulated)
    assert reported(simulated, verbose=True).endswith("\nJudged in simulated time: The node waits only for ROS time.\n")
    assert "Judged in wall time" in reported(dataclasses.replace(simulated, clock="wall"))
    other = dataclasses.replace(simulated, clock_why="it waits for ROS time; eight in wall time: it sleeps")
    assert "eight in wall time" in reported(other)


def test_a_run_without_a_sandbox_is_reported_in_one_line() -> None:
    lines = reported(report("passed", confined=False), width=200).splitlines()
    assert [line for line in lines if "sandbox" in line] == [UNCONFINED]
    assert "sandbox" not in reported(report("passed"))
    lines = reported(report("passed", confined=None), width=200).splitlines()
    assert [line for line in lines if "sandbox" in line] == [UNKNOWN]


def worth(points: float, *, others: tuple[float, ...] = (100.0,)) -> Report:
    """Return a report with passed checks and one failed check that is worth this many points."""
    first = report("passed").outcomes[0]
    good = [replace(first, id=str(place), points=each, max=each) for place, each in enumerate(others)]
    bad = replace(first, id="bad", points=0.0, max=points, finding=failed("Too slow.", "Faster.", Cause("wrong-rate")))
    return report("passed", outcomes=(*good, bad))


@pytest.mark.parametrize(
    ("made", "verdict", "exit_code"),
    [
        (worth(0.0), "Passed: 100 of 100 points, with 1 warning: see the checks that did not pass.", 0),
        (worth(5.0), "Not passed yet: 100 of 105 points, 1 check failed.", 1),
        (worth(0.0, others=(0.0,)), "Not passed yet: 0 of 0 points, 1 check failed.", 1),
    ],
)
def test_a_failed_check_without_points_is_a_warning(made: Report, verdict: str, exit_code: int) -> None:
    assert (reported(made).splitlines()[-1], made.exit_code) == (verdict, exit_code)


@pytest.mark.parametrize(
    ("status", "verdict"),
    [
        ("passed", "Passed: 100 of 100 points."),
        ("skipped", "Not passed yet: 0 of 100 points, 1 check failed, 11 not judged because of that."),
        ("error", "Not finished: 12 checks could not be judged. 0 of 100 points so far."),
    ],
)
def test_each_status_has_its_verdict(status: str, verdict: str) -> None:
    assert verdict in reported(report(status)).splitlines()


def test_a_check_that_passed_takes_one_line() -> None:
    text = reported(report("passed"))
    assert "✓ The turtle drives a circle  25/25\n" in text
    assert "seen" not in text


def test_a_failed_check_has_observed_expected_why_and_where() -> None:
    text = reported(report("failed"))
    start = text.index("✗ The turtle drives a circle  0/25\n")
    assert text[start:].splitlines()[1:5] == [
        "    seen: The radius of the circle is 2.2 m.",
        "    expected: The turtle drives a circle of radius 2.0 m, counter-clockwise, for at least 1 turn.",
        "    likely: The radius is linear.x divided by angular.z: 2.2 / 1.0 = 2.2 m.",
        "    where: my_robot_controller/draw_circle.py:15",
    ]


def test_brief_lists_only_what_did_not_pass() -> None:
    console = Console(file=io.StringIO(), width=200)
    made = report("skipped")
    render(made, console, brief=True)
    assert isinstance(console.file, io.StringIO)
    signs = [line[0] for line in console.file.getvalue().splitlines()[1:] if line and line[0] in "✓✗-"]
    assert signs == ["✗"]
    amount = len(made.with_status(Status.PASSED))
    assert f"{amount} checks passed. To see all checks, run `grader check`" in console.file.getvalue()


def test_an_error_has_no_points_so_far_and_says_what_to_do() -> None:
    text = reported(report("error"))
    assert "! The turtle drives a circle  0/25 so far\n" in text
    assert "    seen: The disk is full: make room, then grade again.\n" in text


def test_the_same_cause_of_several_checks_is_printed_once() -> None:
    assert reported(report("error")).count("The disk is full") == 1
    assert reported(report("skipped")).count("Not judged, because") == 1


@pytest.mark.parametrize(("hidden", "amount"), [(False, 1), (True, 0)])
def test_a_cross_is_never_without_text(*, hidden: bool, amount: int) -> None:
    """A check with the reason of the previous one refers to it, unless the previous one is hidden."""
    made = report("failed")
    bad = next(outcome for outcome in made.outcomes if outcome.status is Status.FAILED)
    twice = (replace(bad, hidden=hidden), replace(bad, title="Another check"))
    text = reported(replace(made, outcomes=twice))
    assert text.count(SAME) == amount
    assert text.count(f"seen: {bad.finding.observed}") == 1


def test_signs_are_ascii_if_the_stream_knows_no_others() -> None:
    text = reported(report("failed"), stream=Latin1())
    assert text.isascii()
    assert "FAIL The turtle drives a circle" in text


def test_a_hidden_check_is_one_line_without_details() -> None:
    made = report("failed")
    hidden = tuple(replace(outcome, hidden=True) for outcome in made.outcomes)
    text = reported(replace(made, outcomes=hidden))
    assert "✗ The turtle drives a circle  0/25\n" in text
    assert "radius" not in text


def test_advice_looks_different_from_a_failure() -> None:
    made = report("passed")
    advice = replace(made.outcomes[-1], finding=failed("The node does not use a timer.", "A timer.", Cause("no-timer")))
    text = reported(replace(made, outcomes=(*made.outcomes[:-1], advice)))
    assert "i The node uses a timer\n    seen: The node does not use a timer.\n" in text
    assert "Passed: 100 of 100 points." in text


def test_the_seed_and_the_recording_are_printed() -> None:
    text = reported(report("passed", seed=7, recording="kept/here"))
    assert "The random inputs of the trials were generated with seed 7.\nRecording: kept/here\n" in text


HOSTILE = st.text(alphabet=st.sampled_from("ab\x1b[]{}/\\\n\r\t\u202e\x9b\x07:red%") | st.characters(), max_size=80)


@given(HOSTILE, st.sampled_from([20, 60, 120]), st.booleans())
def test_text_of_a_student_cannot_control_the_terminal(text: str, width: int, terminal: bool) -> None:
    made = report("passed")
    finding = failed(text, text, Cause("crash", text, Where(text, 3)))
    outcomes = (replace(made.outcomes[0], title=text, finding=finding), replace(made.outcomes[1], finding=passed(text)))
    shown = reported(replace(made, outcomes=outcomes, submission=text), width=width, terminal=terminal)
    for own in ("\x1b[0m", "\x1b[1m", "\x1b[2m", "\x1b[32m", "\x1b[36m", "\x1b[1;31m", "\x1b[1;32m", "\x1b[2;32m"):
        shown = shown.replace(own, "")
    assert [char for char in shown if not char.isprintable() and char != "\n"] == []


def test_markup_is_printed_as_plain_text() -> None:
    made = report("passed", submission="[bold]alice[/bold] [link=x]y[/link]")
    assert reported(made).startswith("Draw a circle: [bold]alice[/bold] [link=x]y[/link]\n")


@pytest.mark.parametrize("width", [20, 40, 80, 200])
@pytest.mark.parametrize("status", ["passed", "failed", "skipped", "error"])
def test_no_line_is_wider_than_the_terminal(status: str, width: int) -> None:
    made = report(status)
    plain = io.StringIO()
    render(made, Console(file=plain, width=width, force_terminal=True, color_system=None))
    assert max(len(line) for line in plain.getvalue().splitlines()) <= width


def test_every_status_has_its_own_sign() -> None:
    made = report("skipped")
    signs = {line[0] for line in reported(made).splitlines()[1:18] if not line.startswith(" ")}
    assert signs == {"✓", "✗", "-"}
    assert made.with_status(Status.SKIPPED)


def test_a_failed_hidden_check_says_that_it_tells_nothing() -> None:
    made = report("failed")
    hidden = replace(
        made, outcomes=tuple(replace(each, hidden=True) if each.id == "circle" else each for each in made.outcomes)
    )
    text = reported(hidden)
    assert f"✗ The turtle drives a circle  0/25\n    {HIDDEN}\n" in text
    assert "radius of the circle" not in text
