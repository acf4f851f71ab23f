"""Grading with real Dask workers, some of which are killed by the test or by a submission."""

from __future__ import annotations

import json
import os
import pickle
import signal
import subprocess
from contextlib import closing, suppress
from typing import TYPE_CHECKING

import pytest

from grader.classroom import dask_engine
from grader.classroom.dask_engine import DaskEngine
from grader.classroom.worker import Worker
from grader.common.interpreter import interpreter
from grader.errors import MachineError, UsageError
from grader.sandbox import bubblewrap
from grader.tests.case import copy_solution
from grader.tests.classroom.a_class import STEP, environment, grade, judged
from grader.tests.classroom.test_class_run import (
    assert_set_aside,
    below,
    command_line,
    graded,
    make_four,
    order_of,
    waited,
)
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from grader.classroom.engine import Event
    from grader.tests.classroom.conftest import Run


class Cluster:
    """A scheduler, and workers that the test starts and kills."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.processes: list[subprocess.Popen[bytes]] = []
        file = folder / "scheduler.json"
        self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-show", "--scheduler-file", file)
        waited(lambda: file.exists() and file.read_text().endswith("}"))
        self.address = json.loads(file.read_text())["address"].removeprefix("tcp://")

    def worker(self, *options: str) -> subprocess.Popen[bytes]:
        """Start a worker with one thread. With a nanny process (the default), a worker that dies is replaced."""
        return self._start("worker", f"tcp://{self.address}", "--nthreads", "1", *options)

    def _start(self, *arguments: object) -> subprocess.Popen[bytes]:
        argv = interpreter("-m", "dask", *map(str, arguments), "--no-dashboard").argv
        log = (self._folder / f"{len(self.processes)}.log").open("wb")
        with log:
            child = subprocess.Popen(
                argv, cwd=self._folder, stdout=log, stderr=log, env=environment(), start_new_session=True
            )
        self.processes.append(child)
        return child

    def close(self) -> None:
        # Dask's nanny process ignores SIGTERM while it starts a worker.
        for process in reversed(self.processes):
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


@pytest.fixture
def cluster(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Cluster]:
    # A busy machine may need a minute until a worker of Dask has started.
    monkeypatch.setattr(dask_engine, "CONNECT_S", HANG_S)
    monkeypatch.setattr(dask_engine, "WORKERS_S", HANG_S)
    if not bubblewrap.usable():
        pytest.skip("there is no sandbox here")
    (tmp_path / "dask").mkdir()
    with closing(Cluster(tmp_path / "dask")) as made:
        yield made


def test_a_submission_that_kills_workers_is_an_error_and_the_others_are_graded(
    cluster: Cluster, tmp_path: Path
) -> None:
    cluster.worker()
    order = order_of(make_four(tmp_path / "class"))
    done = graded(order, DaskEngine(cluster.address, None), tmp_path / "grades")
    assert_set_aside(done)


def test_the_submission_of_a_lost_worker_is_graded_by_another(cluster: Cluster, tmp_path: Path) -> None:
    lost = cluster.worker("--no-nanny")
    copy_solution(STEP, tmp_path / "class" / "anna")

    class Striking(DaskEngine):
        """An engine that loses its only worker during a submission and gets another worker later."""

        def events(self, timeout_s: float) -> list[Event]:
            if self._running and lost.poll() is None:
                waited(lambda: [pid for pid in below(lost.pid) if b"grader.classroom.worker" in command_line(pid)])
                lost.kill()
                lost.wait()
                cluster.worker("--no-nanny")
            return super().events(timeout_s)

    done = graded(order_of(tmp_path / "class"), Striking(cluster.address, None), tmp_path / "grades")
    assert lost.returncode == -signal.SIGKILL
    assert done["anna"].report.points == 100.0


def test_a_submission_that_does_not_end_does_not_keep_a_worker_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    class Hung(Worker):
        """A worker process that was stopped, as if its task did not end."""

        def send(self, _: object) -> None:
            self.process.signal(signal.SIGSTOP)
            started.append(self)

    started: list[Worker] = []
    monkeypatch.setattr(dask_engine, "Worker", Hung)
    monkeypatch.setattr(dask_engine, "TASK_S", 0.6)
    assert dask_engine.perform_here(pickle.dumps(None)) == ("died", "it was still busy after 0 minutes")
    assert [worker.process.returncode for worker in started] == [-signal.SIGKILL]


def test_a_missing_scheduler_is_a_usage_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_engine, "CONNECT_S", 0.2)
    with pytest.raises(UsageError, match=r"No Dask scheduler responds at 127\.0\.0\.1:1"):
        DaskEngine("127.0.0.1:1", None)


@pytest.mark.exhaustive
def test_without_a_worker_the_user_is_told_how_to_start_one(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    copy_solution(STEP, tmp_path / "class" / "anna")
    monkeypatch.setattr(dask_engine, "WORKERS_S", 0.1)
    told: list[str] = []
    engine = DaskEngine(cluster.address, None, told.append)
    (sentence,) = told
    assert f"`python -I -m dask worker {cluster.address}`" in sentence
    with pytest.raises(MachineError, match="Dask has had no worker for 0 s: start one with"):
        graded(order_of(tmp_path / "class"), engine, tmp_path / "grades")


def test_dask_gives_the_same_results(cluster: Cluster, undisturbed: Run, tmp_path: Path) -> None:
    for _ in range(2):
        cluster.worker()
    arguments = ("--exercise", STEP, "--out", tmp_path / "grades", "--engine", f"dask://{cluster.address}")
    done = grade(undisturbed.submitted, *arguments)
    assert done.returncode == 0, done.stderr
    assert judged(tmp_path / "grades") == judged(undisturbed.out)
