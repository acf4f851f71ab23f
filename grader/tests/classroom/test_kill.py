"""After a run was killed or could not write, the same command continues. No result is lost or duplicated."""

from __future__ import annotations

import functools
import os
import random
import resource
import shutil
import signal
import subprocess
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import pytest

from grader.tests.classroom.a_class import POINTS, STEP, command, environment, grade, judged, rows
from grader.tests.classroom.test_class_run import command_line

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.tests.classroom.conftest import Run

Blow = Literal["grader", "worker", "disk"]
LONGEST_S = 600.0
NO_ROOM = 4096
"""A limit on the file size (bytes) that every report exceeds."""


class Killer:
    """Run the command, interrupt it at random times that a seed determines, and start it again until it finishes."""

    def __init__(self, run: Run, out: Path, seed: int) -> None:
        self._arguments = (run.submitted, "--exercise", STEP, "--out", out)
        self._out = out
        self._draw = random.Random(seed)
        self.struck: list[Blow] = []

    def until_struck(self, blows: list[Blow], within_s: float) -> None:
        """Start one run for each of these methods, and interrupt the run with this method unless it has finished."""
        for blow in blows:
            with subprocess.Popen(
                command(*self._arguments),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                env=environment(),
            ) as child:
                until(child, functools.partial(has_workers, child.pid), LONGEST_S)
                until(child, lambda: False, self._draw.uniform(0.0, within_s))
                if child.poll() is None and self._strike(child.pid, blow):
                    self.struck.append(blow)
                assert child.stderr is not None
                child.stderr.read()
                child.wait(LONGEST_S)

    def finish(self) -> None:
        done = grade(*self._arguments)
        assert done.returncode == 0, done.stderr

    def _strike(self, pid: int, blow: Blow) -> bool:
        try:
            if blow == "grader":
                os.kill(pid, signal.SIGKILL)
            elif blow == "disk":
                # From now on, the disk is full for the grader.
                resource.prlimit(pid, resource.RLIMIT_FSIZE, (NO_ROOM, resource.RLIM_INFINITY))
            else:
                workers = workers_of(pid)
                if not workers:
                    return False
                os.kill(self._draw.choice(workers), signal.SIGKILL)
        except ProcessLookupError:
            return False
        return True


def until(child: subprocess.Popen[bytes], observed: Callable[[], bool], seconds: float) -> None:
    """Wait until a condition is true, the child process has ended, or the deadline has passed."""
    end = time.monotonic() + seconds
    while child.poll() is None and time.monotonic() < end and not observed():
        time.sleep(0.01)


def has_workers(pid: int) -> bool:
    return bool(workers_of(pid))


def workers_of(pid: int) -> list[int]:
    """Return the worker processes. For a moment, the grader can also have child processes that are not workers."""
    found: list[int] = []
    with suppress(OSError):  # the process has ended
        for task in Path(f"/proc/{pid}/task").iterdir():
            found += map(int, (task / "children").read_text().split())
    return [child for child in found if b"grader.classroom.worker" in command_line(child)]


def assert_nothing_lost(run: Run, out: Path) -> None:
    assert judged(out) == judged(run.out)
    assert sorted(row["submission"] for row in rows(out)) == sorted(POINTS)
    files = sorted(file.name for file in (out / "reports").iterdir())
    assert files == sorted(file.name for file in (run.out / "reports").iterdir())


def test_no_result_is_lost_when_the_run_is_killed_three_times(
    undisturbed: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (temporary := tmp_path / "temporary").mkdir()
    monkeypatch.setenv("TMPDIR", str(temporary))
    blows: list[Blow] = ["grader", "disk", "worker"]
    for seed in range(8, 14):
        out = tmp_path / f"grades-{seed}"
        killer = Killer(undisturbed, out, seed)
        killer.until_struck(blows, within_s=2.0)
        killer.finish()
        assert_nothing_lost(undisturbed, out)
        assert [path.name for path in temporary.rglob("grader-*")] == []
        # If this process had to wait for a processor, a run may have finished before it was interrupted.
        if killer.struck == blows:
            return
    pytest.fail("each time, a run finished before it was interrupted")


@pytest.mark.exhaustive
@pytest.mark.timeout(7200)
def test_no_result_is_lost_when_the_run_is_killed_fifty_times(undisturbed: Run, tmp_path: Path) -> None:
    struck: list[Blow] = []
    seed = 0
    while len(struck) < 50:
        out = tmp_path / f"grades-{seed}"
        killer = Killer(undisturbed, out, seed)
        # A run whose worker was killed still finishes, so do this last.
        blows: list[Blow] = ["grader", "disk", "grader"]
        random.Random(seed).shuffle(blows)
        killer.until_struck([*blows, "worker"], within_s=6.0)
        killer.finish()
        struck += killer.struck
        assert_nothing_lost(undisturbed, out)
        seed += 1
    assert {"grader", "worker", "disk"} <= set(struck)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can mount a small disk")
def test_a_full_disk_stops_the_run_with_a_message_and_it_continues_later(undisturbed: Run, tmp_path: Path) -> None:
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", disk], capture_output=True, check=False
    )
    if mounted.returncode != 0:
        pytest.skip("a small disk cannot be mounted here")
    try:
        two = tmp_path / "two"
        for student in ("anna", "gina"):
            shutil.copytree(undisturbed.submitted / student, two / student)
        arguments = (two, "--exercise", STEP, "--out", disk / "grades")
        full = grade(*arguments)
        assert (full.returncode, "No space left on device" in full.stderr) == (3, True), full.stderr
        assert not list((disk / "grades").rglob("*.partial"))
        subprocess.run(["mount", "-o", "remount,size=16m", disk], check=True)
        assert grade(*arguments).returncode == 0
        whole = judged(undisturbed.out)
        assert judged(disk / "grades") == {student: whole[student] for student in ("anna", "gina")}
    finally:
        subprocess.run(["umount", disk], check=True)
