"""Grade cases in this process. Submissions that differ only in their modules share one build."""

from __future__ import annotations

import io
import threading
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rich.console import Console

from grader.checks.exercises import find_exercise
from grader.colcon import runner
from grader.colcon.rebuild import renewed
from grader.errors import UsageError
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.report import terminal
from grader.report.json import to_data
from grader.sandbox import bubblewrap
from grader.submission.package import open_answers, open_submission
from grader.tests.case import make_submission
from grader.tests.gradings import AT_ONCE, EXERCISE, Graded, until_judged

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    import pytest

    from grader.grading.clock import ClockChoice
    from grader.ros.installation import Ros
    from grader.submission.package import Submission
    from grader.tests.case import Case

    Grade = Callable[[Case, ClockChoice], Graded]


class Builds:
    """A replacement for `runner.build`: colcon runs once for all submissions that differ only in modules."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._known: dict[object, _Kept] = {}

    def __call__(
        self,
        submission: Submission,
        ros: Ros,
        *,
        in_cell: bool,
        tell: Callable[[str], None],
    ) -> runner.Built:
        """Build the submission, with or without colcon."""
        with self._lock:
            kept = self._known.setdefault(_alike(submission), _Kept(threading.Lock()))
        with kept.lock:
            again = renewed(submission, *kept.first) if kept.first else None
            if again is not None:
                return again
            built = runner.build(submission, ros, in_cell=in_cell, tell=tell)
            kept.first = kept.first or (submission, built)
            return built


@dataclass
class _Kept:
    lock: threading.Lock
    first: tuple[Submission, runner.Built] | None = None


def _alike(submission: Submission) -> object:
    others = ((path, b"" if path.endswith(".py") and "/" in path else data) for path, data in submission.files.items())
    return tuple(sorted(others)), submission.executable


def grade_here(case: Case, clock: ClockChoice, folder: Path, builds: Builds) -> Graded:
    """Return the report of `grader check`, and the text that the command would print without colours."""
    given = make_submission(case, folder / "in")
    exercise = find_exercise(case.exercise or case.base or EXERCISE)
    try:
        submission = open_submission(given) if exercise.package else open_answers(given)
    except UsageError as error:
        return Graded(2, "", str(error), None)

    def attempt() -> Graded:
        reported: list[str] = []
        report = grade(exercise, submission, Options(bubblewrap.usable(), clock), reported.append, build=builds).report
        page = Console(file=io.StringIO(), width=120)
        terminal.render(report, page)
        assert isinstance(page.file, io.StringIO)
        return Graded(report.exit_code, page.file.getvalue(), "\n".join(reported), to_data(report))

    return until_judged(attempt)


def all_graded_here(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Grade]:
    """Yield the fixture `graded`, a function that grades a case with a clock.

    All cases of a module are graded in parallel.
    """
    folder, builds = tmp_path_factory.mktemp("graded"), Builds()
    futures: dict[tuple[str, str], Future[Graded]] = {}
    with ThreadPoolExecutor(AT_ONCE) as pool:

        def submit(case: Case, clock: ClockChoice) -> Future[Graded]:
            if (case.name, clock) not in futures:
                place = folder / f"{case.name}.{clock}"
                futures[case.name, clock] = pool.submit(grade_here, case, clock, place, builds)
            return futures[case.name, clock]

        for item in request.session.items:
            if item.path == request.path and hasattr(item, "callspec"):
                for mark in item.iter_markers("clocks"):
                    for clock in mark.args:
                        submit(item.callspec.params["case"], clock)
        yield lambda case, clock: submit(case, clock).result()
        pool.shutdown(cancel_futures=True)
