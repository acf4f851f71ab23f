"""A submission that ends with an `error` is graded again if other submissions could be judged.

An error that occurs repeatedly is suspicious.
"""

from __future__ import annotations

import csv
import io
from collections import Counter, deque
from typing import TYPE_CHECKING

import pytest

from grader.classroom import result_files
from grader.classroom.class_run import TRIES, run
from grader.classroom.engine import Died, Event, Finished
from grader.classroom.found import Found
from grader.classroom.order import Order, sort_out, sources_for
from grader.classroom.progress_display import Lines
from grader.classroom.results import Result, opened
from grader.classroom.task import Done, Task
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from pathlib import Path

STEP = "03-circle-publisher"


class Scripted:
    """An engine with a planned sequence of results for each submission.

    After all planned results, the last result is repeated.
    """

    def __init__(self, ends: dict[str, list[str]]) -> None:
        self.graded: Counter[str] = Counter()
        self._ends = ends
        self._tasks: deque[Task] = deque()

    def __enter__(self) -> Scripted:  # noqa: PYI034 - typing.Self is Python 3.11's
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def has_room(self) -> bool:
        return not self._tasks

    def start(self, task: Task) -> None:
        self._tasks.append(task)

    def events(self, _: float) -> list[Event]:
        task = self._tasks.popleft()
        ends = self._ends[task.student]
        end = ends[min(self.graded[task.student], len(ends) - 1)]
        self.graded[task.student] += 1
        if end == "died":
            return [Died(task, "it was killed")]
        return [Finished(task, Done(report(end, submission=task.student), b"a page"))]


@pytest.fixture
def out(tmp_path: Path) -> Path:
    return tmp_path / "grades"


def graded(folder: Path, out: Path, engine: Scripted, ends: dict[str, list[str]]) -> dict[str, Result]:
    for student in ends:
        (folder / student).mkdir(parents=True, exist_ok=True)
    found = tuple(Found(student, STEP, folder / student) for student in sorted(ends))
    order = Order(found=found, roster={}, sources=sources_for(found, None), ros="none")
    with opened(out) as results:
        kept, todo = sort_out(order, results)
        done = [*kept, *run(order, todo, engine, results, Lines(len(todo), several=False))]
        result_files.write_all(results, done)
    assert len(done) == len(found)
    return {result.student: result for result in done}


def attention(out: Path) -> dict[str, str]:
    text = (out / "summary.csv").read_text("utf-8-sig")
    return {row["submission"]: row["attention"] for row in csv.DictReader(io.StringIO(text))}


def test_an_error_by_chance_is_graded_again(tmp_path: Path, out: Path) -> None:
    ends = {"anna": ["passed"], "ben": ["error", "passed"], "clara": ["failed"]}
    engine = Scripted(ends)
    done = graded(tmp_path / "class", out, engine, ends)
    assert engine.graded == {"anna": 1, "ben": 2, "clara": 1}
    assert (done["ben"].report.exit_code, done["ben"].errors) == (0, 0)
    assert set(attention(out).values()) == {""}


def test_an_error_that_repeats_while_others_are_judged_is_suspicious(tmp_path: Path, out: Path) -> None:
    ends = {"anna": ["passed"], "ben": ["error"], "clara": ["died"]}
    engine = Scripted(ends)
    done = graded(tmp_path / "class", out, engine, ends)
    assert engine.graded == {"anna": 1, "ben": TRIES, "clara": TRIES}
    assert (done["ben"].errors, done["clara"].errors) == (TRIES, TRIES)
    reported = attention(out)
    assert reported["anna"] == ""
    assert "suspicious: it could not be judged in 2 consecutive attempts" in reported["ben"]
    assert "suspicious" in reported["clara"]
    assert "2 consecutive attempts" in (out / "index.html").read_text("utf-8")
    # The next run continues to count until the submission is judged.
    assert graded(tmp_path / "class", out, Scripted(ends), ends)["ben"].errors == 2 * TRIES
    ends["ben"] = ["failed"]
    assert graded(tmp_path / "class", out, Scripted(ends), ends)["ben"].errors == 0
    assert attention(out)["ben"] == ""


def test_if_nothing_is_judged_no_submission_is_suspicious_or_tried_again(
    tmp_path: Path, out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ends = {"anna": ["error"], "ben": ["error"]}
    engine = Scripted(ends)
    graded(tmp_path / "class", out, engine, ends)
    assert engine.graded == {"anna": 1, "ben": 1}
    assert set(attention(out).values()) == {""}
    assert "[2/2]" in capsys.readouterr().err
