"""If reading a submission makes the grader fail, the submission fails.

Only faults of the machine itself get the status `error`.
"""

from __future__ import annotations

import errno
import os
from typing import TYPE_CHECKING, Any, NoReturn

import pytest

from grader.checks.judge import judge, judge_so_far
from grader.checks.outcome import Status
from grader.colcon.runner import Built
from grader.errors import MachineError
from grader.evidence import evidence as of_evidence
from grader.grading import clock as of_clock
from grader.grading import judging
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.report import html, html_notebook
from grader.submission import reader
from grader.tests.checks.made import BUILD, exercise, good, submission
from grader.tests.grading.test_starved import Trials
from grader.tests.no_ros import without_ros

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from grader.grading.grade import Graded


@pytest.fixture(autouse=True)
def no_ros(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    without_ros(tmp_path, monkeypatch)


def graded(build: Callable[..., Built] = lambda *_, **__: Built(BUILD, b""), trial: Any = None) -> Graded:  # noqa: ANN401
    return grade(exercise(), submission(), Options(in_cell=False), build=build, trial=trial or Trials([good()]))


def breaks(error: BaseException) -> Callable[..., NoReturn]:
    def broken(*_: object, **__: object) -> NoReturn:
        raise error

    return broken


def broken_trial(error: BaseException) -> Trials:
    trials = Trials([])
    trials.run = breaks(error)  # type: ignore[method-assign]
    return trials


def reported(of: Graded) -> dict[str, tuple[Status, str | None]]:
    return {outcome.id: (outcome.status, outcome.finding.diagnosis) for outcome in of.report.outcomes}


@pytest.mark.parametrize("error", [RecursionError("too deep"), ValueError("odd"), KeyError("x")])
def test_an_unreadable_result_of_the_build_fails_the_build(error: Exception) -> None:
    found = graded(build=breaks(error))
    assert reported(found)["build"] == (Status.FAILED, "unreadable")
    assert found.report.with_status(Status.ERROR) == ()
    assert (found.report.exit_code, found.report.max) == (1, 100.0)


@pytest.mark.parametrize("error", [RecursionError("too deep"), ValueError("odd")])
def test_an_unreadable_result_of_the_trial_fails_the_start(error: Exception) -> None:
    found = graded(trial=broken_trial(error))
    assert reported(found)["build"] == (Status.PASSED, None)
    assert reported(found)["start"] == (Status.FAILED, "unreadable")
    assert found.report.with_status(Status.ERROR) == ()


@pytest.mark.parametrize(
    "error",
    # Reading has limits, so a MemoryError is the machine's fault. An `error` that repeats is reported as suspicious.
    [MachineError("The disk is full."), OSError(errno.EMFILE, "Too many open files"), MemoryError()],
)
@pytest.mark.parametrize("where", ["build", "trial"])
def test_the_machines_faults_are_errors(error: Exception, where: str) -> None:
    found = graded(build=breaks(error)) if where == "build" else graded(trial=broken_trial(error))
    assert {outcome.status for outcome in found.report.outcomes if outcome.id == "circle"} == {Status.ERROR}
    assert found.report.with_status(Status.FAILED) == ()
    assert found.report.exit_code == 3


def test_a_source_that_breaks_its_reader_fails_and_the_node_is_run_in_wall_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(of_evidence, "read_code", breaks(RecursionError("too deep")))
    monkeypatch.setattr(of_clock, "wall_clues", breaks(RecursionError("too deep")))
    trials = Trials([good()])
    found = graded(trial=trials)
    assert len(trials.alone) == 1
    assert "could not be read (RecursionError: too deep)" in found.evidence.recording.why
    assert found.report.with_status(Status.ERROR) == ()
    assert reported(found)["circle"] == (Status.PASSED, None)


def spins(*_: object) -> NoReturn:
    while True:
        pass


def ends(*_: object) -> NoReturn:
    os.abort()


@pytest.mark.parametrize(
    ("how", "why"), [(spins, "too large to be read"), (ends, "the reading process was stopped by SIG")]
)
@pytest.mark.parametrize("when", ["early", "after the build"])
def test_a_submission_that_crashes_its_reader_fails_and_is_not_read_again(
    monkeypatch: pytest.MonkeyPatch, when: str, how: Callable[..., NoReturn], why: str
) -> None:
    monkeypatch.setattr(reader, "CPU_S", 1)
    monkeypatch.setattr(judging, "judge_early" if when == "early" else "judge_so_far", _in_a_child(how))
    trials = Trials([good()])
    found = graded(trial=trials)
    assert {status for status, _ in reported(found).values()} == {Status.FAILED, Status.SKIPPED}
    first = found.report.outcomes[0].finding
    assert (first.diagnosis, found.report.points, found.report.max) == ("unreadable", 0.0, 100.0)
    assert why in first.observed
    assert found.evidence.runs == {}
    assert judge(found.evidence) == found.report.outcomes  # like `regrade`, which does not read the submission


def _in_a_child(how: Callable[..., NoReturn]) -> Callable[..., Any]:
    """Return a judge that fails in a child process and works normally in this process, as in `regrade`."""
    return lambda *given: how() if reader._Child.inside else judge_so_far(*given)


def test_a_page_that_cannot_be_drawn_tells_the_verdict_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    found = graded()
    for module in (html, html_notebook):
        real = module.runs_of

        def runs_of(evidences: Any, *rest: Any, real: Any = real) -> Any:  # noqa: ANN401
            if any(evidence.run.recording for evidence in evidences):
                raise OverflowError
            return real(evidences, *rest)

        monkeypatch.setattr(module, "runs_of", runs_of)
    for page in (
        html.html_page(found.evidence, found.report),
        html_notebook.html_fragment(found.evidence, found.report),
    ):
        assert "Passed: 100 of 100 points." in page
        assert "The turtle drives a circle" in page
