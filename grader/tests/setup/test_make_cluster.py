"""`make cluster` in a fresh clone: a Dask worker grades a submission."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

import pytest

from grader.tests import waiting
from grader.tests.setup.fresh import Clone, clone

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = [pytest.mark.exhaustive, pytest.mark.door]
STEP = "03-circle-publisher"


@contextmanager
def cluster(course: Clone) -> Iterator[str]:
    """Start a scheduler and a worker with the documented commands. Yield the name of the engine."""
    address = course.home / "scheduler.json"
    commands = [
        ["scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(address)],
        ["worker", "--scheduler-file", str(address), "--nthreads", "1"],
    ]
    processes: list[subprocess.Popen[bytes]] = []
    try:
        for number, command in enumerate(commands):
            with (course.home / f"{number}.log").open("wb") as log:
                started = subprocess.Popen(
                    [course.folder / ".venv/bin/dask", *command, "--no-dashboard"],
                    cwd=course.home,
                    env=course.environment(),
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=log,
                    start_new_session=True,
                )
            processes.append(started)
        waiting.until(lambda: address.exists() and address.read_text().endswith("}"))
        yield json.loads(address.read_text())["address"].replace("tcp://", "dask://")
    finally:
        for process in processes:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def test_a_dask_worker_grades(tmp_path: Path) -> None:
    course = clone(tmp_path)
    course.make("cluster")
    assert course.lacks("jupyterlab")
    shutil.copytree(course.folder / "solutions" / STEP / "my_robot_controller", course.home / "class/ada")
    with cluster(course) as engine:
        course.run(f".venv/bin/grader grade ~/class --exercise {STEP} --engine {engine} --out ~/grades")
    assert "ada,100,100,100.0,passed" in course.run("cut -d, -f1,3-6 ~/grades/summary.csv")
