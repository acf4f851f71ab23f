"""The behaviour of a run when its workers die. The workers are real, and submissions kill them."""

from __future__ import annotations

import dataclasses
import os
import signal
import subprocess
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import pytest

from grader.checks.outcome import Status
from grader.classroom import local
from grader.classroom.class_run import run
from grader.classroom.find_submissions import find_submissions
from grader.classroom.local import LocalEngine, default_jobs
from grader.classroom.order import Order, sort_out, sources_for
from grader.classroom.progress_display import Lines
from grader.classroom.results import opened
from grader.classroom.task import Task
from grader.classroom.worker import Worker
from grader.ros.installation import find_ros
from grader.sandbox import bubblewrap
from grader.tests.case import copy_solution
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.classroom.engine import Engine
    from grader.classroom.found import Found
    from grader.classroom.results import Result

T = TypeVar("T")
STEP = "03-circle-publisher"
DEATH = "__import__('os').kill(__import__('os').getpid(), 9)"


class Deadly(Task):
    """A task that kills the process that unpickles it."""

    def __reduce__(self) -> tuple[Any, ...]:
        return eval, (DEATH,)


@dataclasses.dataclass(frozen=True)
class DeadlyOrder(Order):
    """A run in which the submission `deadly` kills every worker that receives it."""

    deadly: str = "deadly"

    def task(self, found: Found) -> Task:
        task = super().task(found)
        if found.student != self.deadly:
            return task
        return Deadly(**{field.name: getattr(task, field.name) for field in dataclasses.fields(Task)})


def order_of(folder: Path) -> DeadlyOrder:
    found = find_submissions([folder], STEP, folder)
    return DeadlyOrder(found=found, roster={}, sources=sources_for(found, None), ros=find_ros().name)


def graded(order: Order, engine: Engine, out: Path) -> dict[str, Result]:
    with opened(out) as results:
        _, todo = sort_out(order, results)
        done = run(order, todo, engine, results, Lines(len(todo), several=False))
    assert len(done) == len(todo)
    return {result.student: result for result in done}


def make_four(folder: Path) -> Path:
    """Create a class of four submissions: one is correct, one kills workers, and two have no package."""
    copy_solution(STEP, folder / "anna")
    copy_solution(STEP, folder / "deadly")
    for student in ("ben", "clara"):
        (folder / student).mkdir()
    return folder


def assert_set_aside(done: dict[str, Result]) -> None:
    aside = done["deadly"].report
    assert {outcome.status for outcome in aside.outcomes} == {Status.ERROR}
    assert "was lost while it was grading" in aside.outcomes[0].finding.observed
    assert (aside.points, aside.max) == (0.0, 100.0)
    ben, clara = (done[student].report.outcomes[1:] for student in ("ben", "clara"))  # the first one names the folder
    assert [id(outcome) for outcome in ben] == [id(outcome) for outcome in clara], "equal outcomes are stored twice"
    assert (done["anna"].report.points, done["ben"].report.points) == (100.0, 0.0)


@pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
def test_a_submission_that_kills_two_workers_is_an_error_and_the_others_are_graded(tmp_path: Path) -> None:
    order = order_of(make_four(tmp_path / "class"))
    done = graded(order, LocalEngine(2), tmp_path / "grades")
    assert_set_aside(done)
    assert "SIGKILL" in done["deadly"].report.outcomes[0].finding.observed
    # An error is not a final result, so the next run grades the submission again.
    with opened(tmp_path / "grades") as results:
        kept, todo = sort_out(order, results)
        _, other = sort_out(dataclasses.replace(order, ros="another"), results)
    assert {one.why for one in other} == {"graded with another ROS 2"}
    assert sorted(result.student for result in kept) == ["anna", "ben", "clara"]
    assert [(one.found.student, one.why) for one in todo] == [("deadly", "not judged last time")]


def test_a_worker_ends_with_its_owner() -> None:
    worker = Worker()
    pid = worker.process.await_started()
    worker.connection.close()
    assert worker.process.wait(HANG_S) == 0
    assert not Path(f"/proc/{pid}/task/{pid}/children").exists()


def test_a_worker_of_another_version_does_not_grade(tmp_path: Path) -> None:
    (tmp_path / "class" / "ben").mkdir(parents=True)
    order = order_of(tmp_path / "class")
    task = dataclasses.replace(order.task(order.found[0]), grader="0.0.1 0123456789abcdef")
    worker = Worker()
    try:
        worker.send(task)
        said = worker.receive()
        assert said is not None
        assert said[0] == "fails"
        assert "a different version of the grader" in str(said[1])
    finally:
        worker.close()


@pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
def test_all_processes_end_with_the_grader(tmp_path: Path) -> None:
    from grader.tests.classroom.a_class import command, environment

    copy_solution(STEP, tmp_path / "class" / "anna")
    setup = tmp_path / "class" / "anna" / "setup.py"
    setup.write_text('import subprocess\nsubprocess.run(["sleep", "1000"])\n')
    child = subprocess.Popen(
        command(tmp_path / "class", "--exercise", STEP, "--out", tmp_path / "grades"),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=environment(),
    )
    try:
        family = waited(lambda: [pid for pid in below(child.pid) if b"sleep" in command_line(pid)])
        everybody = below(child.pid)
        assert family
    finally:
        child.send_signal(signal.SIGKILL)
        child.wait()
    waited(lambda: not [pid for pid in everybody if command_line(pid)])


def waited(ready: Callable[[], T]) -> T:
    end = time.monotonic() + HANG_S
    while time.monotonic() < end:
        found = ready()
        if found:
            return found
        time.sleep(0.02)
    pytest.fail("the condition never held")


def below(pid: int) -> list[int]:
    found, waiting = [], [pid]
    while waiting:
        process = waiting.pop()
        try:
            for task in os.listdir(f"/proc/{process}/task"):  # noqa: PTH208
                waiting += map(int, Path(f"/proc/{process}/task/{task}/children").read_text().split())
        except OSError:
            continue
        if process != pid:
            found.append(process)
    return found


def command_line(pid: int) -> bytes:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return b""


def test_there_is_always_at_least_one_job() -> None:
    assert 1 <= default_jobs() <= 1.5 * (os.cpu_count() or 1)


@pytest.mark.parametrize(
    ("processors", "free_gib", "jobs"), [(1, 64, 1), (2, 64, 3), (8, 64, 12), (8, 4, 2), (2, 1, 1)]
)
def test_three_jobs_share_two_processors_if_the_memory_is_sufficient(
    monkeypatch: pytest.MonkeyPatch, processors: int, free_gib: int, jobs: int
) -> None:
    monkeypatch.setattr(local, "_processors", lambda: processors)
    monkeypatch.setattr(local, "_memory", lambda: free_gib * 1024**3)
    assert default_jobs() == jobs
