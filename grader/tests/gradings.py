"""Grade cases in parallel with the real command, and compare the reports with the expected reports."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from grader.tests.case import EXIT_CODES, Case, make_submission
from grader.tests.waiting import HANG_S, is_crowded

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

EXERCISE = "03-circle-publisher"
GRADER = Path(sys.executable).with_name("grader")
AT_ONCE = max(1, (os.cpu_count() or 1) // int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1")))
"""The number of cases that are graded in parallel. Together with the other test processes, these cases use every
processor."""

MOST_ATTEMPTS = 4
"""The maximum number of attempts to grade a case that can only be judged in wall time, on a machine that is busy."""
PRIORITY = -10
"""With this nice value, a trial in wall time was judged at once with a load of 33 to 38 on two processors. With the
nice value 0, none of its three repetitions was."""


@dataclass(frozen=True)
class Graded:
    """The result of one `grader check`. `report` is None if the command wrote no report."""

    exit_code: int
    stdout: str
    stderr: str
    report: dict[str, Any] | None

    def outcomes(self) -> dict[str, dict[str, Any]]:
        assert self.report is not None, self.stderr or self.stdout
        return {outcome["id"]: outcome for outcome in self.report["outcomes"]}


class Gradings:
    """Grades the cases that a module needs, of which `AT_ONCE` are graded at the same time."""

    def __init__(self, wanted: list[tuple[Case, str]], folder: Path, pool: ThreadPoolExecutor) -> None:
        self._futures: dict[tuple[Path, str], Future[Graded]] = {
            (case.folder, clock): pool.submit(
                grade, case, clock, folder / f"{case.folder.parent.name}-{case.name}.{clock}"
            )
            for case, clock in wanted
        }

    def of(self, case: Case, clock: str = "auto") -> Graded:
        return self._futures[case.folder, clock].result()


def grade(case: Case, clock: str, folder: Path) -> Graded:
    submission = make_submission(case, folder / "in")
    json_file = folder / "report.json"
    command = [
        str(GRADER),
        "check",
        str(submission),
        "--exercise",
        case.exercise or case.base or EXERCISE,
        "--clock",
        clock,
        "--json",
        str(json_file),
    ]

    def attempt() -> Graded:
        json_file.unlink(missing_ok=True)
        done = subprocess.run(command, capture_output=True, timeout=HANG_S, check=False, stdin=subprocess.DEVNULL)
        return Graded(
            done.returncode,
            done.stdout.decode("utf-8", "replace"),
            done.stderr.decode("utf-8", "replace"),
            json.loads(json_file.read_bytes()) if json_file.is_file() else None,
        )

    return until_judged(attempt)


def until_judged(attempt: Callable[[], Graded]) -> Graded:
    """Grade again while the report says that the machine was too busy, and other programs do keep it busy.

    If this does not help, return the last result.
    """
    graded = attempt()
    for _ in range(MOST_ATTEMPTS - 1):
        if not is_crowded(str(graded.report)):
            break
        with higher_priority():
            graded = attempt()
    return graded


@contextmanager
def higher_priority() -> Iterator[None]:
    """Let this thread and the processes that it starts run before those of other programs, if this user is root.

    On Linux, each thread has its own priority (setpriority(2), "C library/kernel differences").
    """
    before = os.getpriority(os.PRIO_PROCESS, 0)
    with suppress(PermissionError):
        os.setpriority(os.PRIO_PROCESS, 0, PRIORITY)
    try:
        yield
    finally:
        os.setpriority(os.PRIO_PROCESS, 0, before)


def gradings_of(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Gradings]:
    """Yield the fixture `gradings`: the results of all cases that the module's tests mark with `clocks`."""
    wanted: dict[tuple[Path, str], tuple[Case, str]] = {}
    for item in request.session.items:
        if item.path != request.path:
            continue
        case = getattr(item, "callspec", None) and item.callspec.params.get("case")  # type: ignore[attr-defined]
        if isinstance(case, Case) and "gradings" in item.fixturenames:  # type: ignore[attr-defined]
            for mark in item.iter_markers("clocks"):
                wanted.update({(case.folder, clock): (case, clock) for clock in mark.args})
    with ThreadPoolExecutor(AT_ONCE) as pool:
        yield Gradings(list(wanted.values()), tmp_path_factory.mktemp("cases"), pool)
        pool.shutdown(cancel_futures=True)


def each(cases: Sequence[Case], *, always: bool = False) -> pytest.MarkDecorator:
    """Run the test for each case that is meant for the installed version of rclpy.

    A case that is not in the sample runs only in `make test-all`, unless `always` is set.
    """
    return pytest.mark.parametrize(
        "case",
        [
            pytest.param(case, id=case.name, marks=() if always or case.sample else pytest.mark.exhaustive)
            for case in cases
            if case.is_of_this_rclpy
        ],
    )


def check_report(case: Case, graded: Graded) -> None:
    """Check that the report matches the case, and contains no traceback of the grader."""
    assert not [line for line in graded.stderr.splitlines() if line.startswith(("Traceback", '  File "'))], (
        graded.stderr
    )
    everything = graded.stdout + graded.stderr + json.dumps(graded.report, ensure_ascii=False)
    assert [text for text in case.never if text in everything] == []
    if case.result == "usage":
        assert graded.report is None
        missing = [text for text in case.says["usage"] if text not in graded.stderr]
        assert (missing, graded.exit_code) == ([], 2), graded.stderr
    else:
        compare(case, graded)


def compare(case: Case, graded: Graded) -> None:
    outcomes = graded.outcomes()
    reported = all_reported(graded)
    not_passed = {id_: outcome["status"] for id_, outcome in outcomes.items() if outcome["status"] != "passed"}
    expected = {**dict.fromkeys((*case.failed, *case.advice), "failed"), **dict.fromkeys(case.skipped, "skipped")}
    assert not_passed == expected, reported
    assert graded.exit_code == EXIT_CODES[case.result], reported
    assert {id_: outcomes[id_]["diagnosis"] for id_ in case.diagnosis} == dict(case.diagnosis), reported
    assert {id_: place_of(outcomes[id_]) for id_ in case.where} == dict(case.where), reported
    for id_, texts in case.says.items():
        said = " ".join(str(outcomes[id_][key]) for key in ("seen", "expected", "cause"))
        assert [text for text in texts if text not in said] == [], reported
    assert graded.report is not None
    if case.points is not None:
        assert graded.report["points"] == pytest.approx(case.points)
    if case.clock:
        assert graded.report["clock"]["used"] == case.clock, reported


def all_reported(graded: Graded) -> str:
    """Return the checks that did not pass, one line each, for the message of a failed test."""
    keys = ("id", "diagnosis", "seen", "expected", "cause")
    lines = [
        " | ".join(str(outcome[key]) for key in keys) + f" | {place_of(outcome)}"
        for outcome in graded.outcomes().values()
        if outcome["status"] in ("failed", "error")
    ]
    assert graded.report is not None
    return "\n".join([*lines, str(graded.report["clock"])])


def place_of(outcome: dict[str, Any]) -> str:
    where = outcome["where"] or {}
    return ":".join(str(where[key]) for key in ("file", "line") if where.get(key) is not None)


def check_clocks_agree(auto: Graded, wall: Graded) -> None:
    """Check that simulated time and wall time give the same statuses, points, diagnoses and causes."""
    keys = ("status", "points", "diagnosis", "cause")
    of_auto, of_wall = (
        {id_: tuple(outcome[key] for key in keys) for id_, outcome in graded.outcomes().items()}
        for graded in (auto, wall)
    )
    assert of_auto == of_wall, f"auto:\n{all_reported(auto)}\nwall:\n{all_reported(wall)}"
