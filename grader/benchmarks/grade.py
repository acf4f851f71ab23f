"""Measure the cost of grading one submission, for several class sizes and several numbers of Dask workers.

    python -m grader.benchmarks.grade [--sizes 25,50,100,200] [--workers 1,2,4] [--dask-size 50] [--jobs N]
                                      [--mix right|all] [--times N]

The cost is relative to F (see grader.benchmarks.check), which is measured before and after the classes in one run.
Each class is mixed: out of every eight submissions, four are correct, three are wrong in different ways, and one is
hostile. With `--mix right`, all submissions are correct. Each submission contains a different comment, since the
submissions of a real class differ, too. In half of the packages, package.xml contains the name of the student, so these
packages cannot share a build. The benchmark also measures the memory of all processes of the run, including those in
sandbox cells. The benchmark samples the memory several times per second, and counts shared memory once.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Event, Thread
from typing import TYPE_CHECKING

from grader.benchmarks.bare import bare_costs
from grader.benchmarks.measure import Cost, cost
from grader.common.interpreter import interpreter
from grader.common.words import count

if TYPE_CHECKING:
    from collections.abc import Iterator

_ROOT = Path(__file__).resolve().parents[2]
_STEP = "03-circle-publisher"
_GRADER = str(Path(sys.executable).with_name("grader"))
_LOOK_S = 0.25
AIM_F = 1.0
"""The target for the wall time per submission on two processors (F)."""


@dataclass(frozen=True)
class ClassCost:
    """The wall and CPU time per submission (s), and the peak memory of the run (MB)."""

    size: int
    wall_s: float
    cpu_s: float
    peak_mb: float


def main() -> None:
    """Measure everything and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--sizes", default="25,50,100,200", help="class sizes to measure (default: 25,50,100,200)")
    parser.add_argument(
        "--workers",
        default="1,2,4",
        help="numbers of Dask workers to measure (default: 1,2,4); empty: do not measure Dask",
    )
    parser.add_argument("--dask-size", type=int, default=50, help="class size for Dask (default: 50)")
    parser.add_argument(
        "--jobs", type=int, help="number of submissions graded in parallel (default: as in `grader grade`)"
    )
    parser.add_argument(
        "--mix",
        choices=("all", "right"),
        default="all",
        help="right: only correct submissions; all: also wrong and hostile ones",
    )
    parser.add_argument(
        "--times", type=int, default=3, help="number of measurements of F before and after the classes (default: 3)"
    )
    arguments = parser.parse_args()
    sizes = [int(size) for size in arguments.sizes.split(",") if size]
    workers = [int(amount) for amount in arguments.workers.split(",") if amount]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bare = _bare(folder, arguments.times)
        rows = []
        for size in sizes:
            rows.append((f"{size} here", class_cost(folder, size, arguments.jobs, arguments.mix)))
            _say(rows[-1])
        for amount in workers:
            rows.append(
                (f"{arguments.dask_size}, {amount} Dask", _dask(folder, arguments.dask_size, amount, arguments.mix))
            )
            _say(rows[-1])
        bare += _bare(folder, arguments.times)
    _print(statistics.median(bare), len(bare), rows)


def _bare(folder: Path, times: int) -> list[float]:
    found = []
    for _ in range(times):
        with tempfile.TemporaryDirectory(dir=folder) as home:
            costs = bare_costs(_ROOT / "solutions" / _STEP, Path(home))
            found.append(sum(each.wall_s for each in costs.values()))
    return found


def class_cost(folder: Path, size: int, jobs: int | None, mix: str) -> ClassCost:
    """Grade a class on this machine, in a folder. `mix` is "right" or "all", as in the option --mix."""
    submitted = _class(folder / f"class-{size}", size, mix)
    options = ["--jobs", str(jobs)] if jobs else []
    return _graded(submitted, size, folder / f"grades-{size}", options)


def _dask(folder: Path, size: int, workers: int, mix: str) -> ClassCost:
    submitted = _class(folder / f"dask-class-{workers}", size, mix)
    with _cluster(folder / f"cluster-{workers}", workers) as (address, processes):
        out = folder / f"dask-grades-{workers}"
        before = sum(map(_cpu_s, processes))
        graded = _graded(submitted, size, out, ["--engine", f"dask://{address}"], processes)
        worked = sum(map(_cpu_s, processes)) - before
    return ClassCost(size, graded.wall_s, graded.cpu_s + worked / size, graded.peak_mb)


def _class(folder: Path, size: int, mix: str) -> Path:
    """Write the submissions of the class. Submissions of the same kind differ in a comment."""
    from grader.tests.attack import make_attack, read_attacks
    from grader.tests.case import copy_solution

    attack = next(attack for attack in read_attacks() if attack.name.startswith("301"))
    for number in range(size):
        student = folder / f"student{number:03}"
        kind = number % 8 if mix == "all" else 0
        if kind == 7:
            make_attack(attack, student)
            node = student / "my_robot_controller" / "my_robot_controller" / "draw_circle.py"
        else:
            copy_solution(_STEP, student)
            node = student / "my_robot_controller" / "draw_circle.py"
        text = node.read_text("utf-8")
        changes = {
            4: ("create_timer(0.5", "create_timer(1.0"),
            5: ("angular.z = 1.0", "angular.z = 2.0"),
            6: ("(self)", "(self"),
        }
        text = text.replace(*changes.get(kind, ("", "")), 1) if kind in changes else text
        node.write_text(f"{text}\n# {student.name}\n", "utf-8")
        if number // 2 % 2:
            manifest = node.parents[1] / "package.xml"
            manifest.write_text(f"{manifest.read_text('utf-8')}<!-- {student.name} -->\n", "utf-8")
    return folder


def _graded(submitted: Path, size: int, out: Path, options: list[str], also: list[int] | None = None) -> ClassCost:
    command = [_GRADER, "grade", str(submitted), "--exercise", _STEP, "--out", str(out), *options]
    with _watched(also or []) as peak:
        # `cost` waits until all children exit, but the processes of a cluster keep running.
        measured = cost(command) if also is None else _alone(command)
    found = len(list((out / "reports").glob("*.json")))
    if found != size:
        message = f"{count(size, 'submission')}, but {count(found, 'result')}"
        raise RuntimeError(message)
    return ClassCost(size, measured.wall_s / size, measured.cpu_s / size, max(peak, default=0.0))


def _alone(command: list[str]) -> Cost:
    """Return the cost of a command that delegates its work to other processes. Running processes do not count."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begun = time.monotonic()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wall_s = time.monotonic() - begun
    # Reap the orphans of a sandbox, so that they are counted. measure.cost has made this process the subreaper.
    while os.waitpid(-1, os.WNOHANG)[0]:
        pass
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return Cost(wall_s, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 0.0)


@contextmanager
def _cluster(folder: Path, workers: int) -> Iterator[tuple[str, list[int]]]:
    """Start a scheduler, and workers with one thread each.

    Yield the scheduler's address, and the process ids of the scheduler and of the workers.
    """
    folder.mkdir()
    file = folder / "scheduler.json"
    started: list[subprocess.Popen[bytes]] = []

    def start(*arguments: str) -> None:
        argv = interpreter("-m", "dask", *arguments, "--no-dashboard").argv
        with (folder / f"{len(started)}.log").open("wb") as log:
            started.append(subprocess.Popen(argv, cwd=folder, stdout=log, stderr=log))

    try:
        start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-show", "--scheduler-file", str(file))
        while not (file.exists() and file.read_text().endswith("}")):
            time.sleep(0.05)
        address = json.loads(file.read_text())["address"]
        for _ in range(workers):
            start("worker", address, "--nthreads", "1", "--no-nanny")
        _wait_for_workers(address, workers)
        yield address.removeprefix("tcp://"), [process.pid for process in started]
    finally:
        # Stop the processes one by one, because a worker that is stopped together with the scheduler may never exit.
        for process in reversed(started):
            process.terminate()
            process.wait()


def _wait_for_workers(address: str, workers: int) -> None:
    from distributed import Client

    with Client(address) as client:  # type: ignore[no-untyped-call]
        client.wait_for_workers(workers)


@contextmanager
def _watched(also: list[int]) -> Iterator[list[float]]:
    """Sample the total memory (MB) of this process's descendants, the processes in `also`, and their descendants."""
    samples: list[float] = []
    stopped = Event()

    def look() -> None:
        while not stopped.wait(_LOOK_S):
            own = [pid for pid in _family([os.getpid(), *also]) if pid != os.getpid()]
            samples.append(sum(_own_mb(pid) for pid in own))

    thread = Thread(target=look, daemon=True)
    thread.start()
    try:
        yield samples
    finally:
        stopped.set()
        thread.join()


def _family(pids: list[int]) -> set[int]:
    found: set[int] = set()
    waiting = list(pids)
    while waiting:
        pid = waiting.pop()
        if pid in found:
            continue
        found.add(pid)
        # Any of the processes may exit in the meantime.
        with suppress(OSError):
            for file in Path(f"/proc/{pid}/task").glob("*/children"):
                with suppress(OSError):
                    waiting += map(int, file.read_text().split())
    return found


def _own_mb(pid: int) -> float:
    """Return the memory of a process (MB). Shared memory is divided among the processes that share it (PSS)."""
    with suppress(OSError):
        for line in Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
            if line.startswith("Pss:"):
                return int(line.split()[1]) / 1024
    return 0.0


def _cpu_s(pid: int) -> float:
    """Return the CPU time of a process and of all its descendants, running or exited (s)."""
    total = 0.0
    for each in _family([pid]):
        try:
            fields = Path(f"/proc/{each}/stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        total += sum(int(field) for field in fields[11:15]) / os.sysconf("SC_CLK_TCK")
    return total


def _say(row: tuple[str, ClassCost]) -> None:
    print(f"{row[0]}: {row[1].wall_s:.2f} s wall per submission", file=sys.stderr, flush=True)


def _print(f_s: float, times: int, rows: list[tuple[str, ClassCost]]) -> None:
    print(f"F = {f_s:.2f} s wall (median of {times})\n")
    print(f"{'per submission':18}{'wall s':>8}{'wall F':>8}{'CPU s':>8}{'CPU F':>8}{'peak MB':>9}")
    for name, one in rows:
        figures = (one.wall_s, one.wall_s / f_s, one.cpu_s, one.cpu_s / f_s)
        print(f"{name:18}" + "".join(f"{figure:8.2f}" for figure in figures) + f"{one.peak_mb:9.0f}")
    print(f"\ntarget: at most {AIM_F:.1f} F wall per submission with two processors, for any class size")


if __name__ == "__main__":
    main()
