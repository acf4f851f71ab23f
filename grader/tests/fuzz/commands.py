"""The commands of the grader with a submission whose code is never run. Builds and trials are invented."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zlib import crc32

from grader.checks.exercises import find_exercise
from grader.checks.outcome import Status
from grader.classroom.content import fingerprint, read
from grader.classroom.find_submissions import find_submissions, passed_over
from grader.classroom.key import Key
from grader.classroom.order import Order, sources_for
from grader.classroom.refused import Refused
from grader.classroom.result_files import write_all
from grader.classroom.results import Results
from grader.classroom.task import perform
from grader.colcon.runner import Built
from grader.errors import UsageError
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.report.html import html_page
from grader.report.html_notebook import html_fragment
from grader.tests.checks.made import BUILD, good, submission

if TYPE_CHECKING:
    from collections.abc import Collection

    from grader.colcon.build import Build
    from grader.grading.clock import ClockChoice
    from grader.report.report import Report
    from grader.submission.package import Submission
    from grader.trial.recording import Recording

STEP = "03-circle-publisher"
KEY = Key("submission", "student", "exercise", "grader", "ros", "options")
WRITTEN = 8
"""One report out of this many is written in every format, since writing takes longer than reading a submission."""


class Trials:
    """A replacement for the class of trials: each trial returns this recording."""

    def __init__(self, recording: Recording) -> None:
        self._recording = recording

    def __call__(self, *_: object, **__: object) -> Any:  # noqa: ANN401 - a Trial to whoever makes it
        return self

    def __enter__(self) -> Trials:  # noqa: PYI034 - typing.Self is Python 3.11's
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def await_ready(self) -> None:
        """Do nothing, because this trial is always ready."""

    def run(self, *_: object) -> Recording:
        """Return the recording."""
        return self._recording

    run_alone = run


def graded(
    given: Submission,
    step: str = STEP,
    build: Build = BUILD,
    recording: Recording | None = None,
    clock: ClockChoice = "wall",
    unjudged: Collection[str] = (),
) -> Report:
    """Return the report. For some inputs, also write the report in every format.

    Only the checks in `unjudged` may end with `error`.
    """
    options = Options(in_cell=False, clock=clock, trials_at_once=1)
    trials = Trials(recording or good())
    done = grade(find_exercise(step), given, options, build=lambda *_, **__: Built(build, b""), trial=trials)
    report = done.report
    errors = [outcome for outcome in report.with_status(Status.ERROR) if outcome.id not in unjudged]
    assert not errors, errors
    if crc32(b"".join(given.files.values())) % WRITTEN != 0:
        return report
    html_fragment(done.evidence, report)
    write(given.name, report, html_page(done.evidence, report))
    return report


def write(student: str, report: Report, page: str) -> None:
    """Write the report in every format of `grade`, and read it again."""
    with tempfile.TemporaryDirectory() as folder:
        results = Results(Path(folder))
        result = results.save(student, report, KEY, page.encode("utf-8", "replace"))
        write_all(results, [result])
        again = results.load(student, report.exercise)
    assert again is not None
    assert again.report.points == report.points


def regraded(folder: Path) -> None:
    """Run `regrade` on the recording in the folder, with all options except `--exercise`."""
    from typer.testing import CliRunner

    from grader.cli import app

    command = ["regrade", str(folder), "--html", str(folder / "a.html"), "--image", str(folder / "a.png")]
    done = CliRunner().invoke(app, [*command, "--json", str(folder / "a.json"), "--verbose"])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception


def graded_files(files: dict[str, bytes], step: str = STEP, **more: Any) -> Report:  # noqa: ANN401
    """Return the report on our package with these files added."""
    ours = submission()
    return graded(type(ours)("anna", ours.package_dir, {**ours.files, **files}, (), "0" * 64), step, **more)


def graded_class(folder: Path) -> None:
    """Check that every submission found in the folder is graded or refused."""
    try:
        found = find_submissions([folder], STEP, folder / "grades")
        passed_over([folder], folder / "grades")
    except UsageError:
        return
    for one in found:
        exercise = find_exercise(one.exercise)
        fingerprint(one, exercise)
        content = read(one, exercise, "anna")
        if isinstance(content, Refused):
            assert not content.of_the_machine, content.reason
            if crc32(one.student.encode("utf-8", "surrogateescape")) % WRITTEN != 0:
                continue
            order = Order(found=(one,), roster={}, sources=sources_for((one,), None), ros="none", trusted=True)
            done = perform(order.task(one))
            assert not done.report.with_status(Status.ERROR)
            write(one.student, done.report, done.page.decode())
        else:
            graded(content)
