"""Measure the most important costs in one run, and print a table of the costs and their target values.

    python -m grader.benchmarks.all [--times N] [--class N] [--sync N]

F is the wall time of a `colcon build` of the package and of a process with one rclpy node, both run without the grader.
Most times are divided by F, as in grader.benchmarks.check. F is measured again for each cost that is divided by F, so
that other programs slow down both alike. The first line shows the load of the machine. Results from a busy machine can
be compared only with each other.
"""

from __future__ import annotations

import argparse
import os
import shutil
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from grader.benchmarks import notebooks
from grader.benchmarks.bare import bare_costs, new_package
from grader.benchmarks.grade import class_cost
from grader.benchmarks.html import page_cost
from grader.benchmarks.measure import Cost, cost
from grader.benchmarks.watch import seconds_to_verdict

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_ROOT = Path(__file__).resolve().parents[2]
_GRADER = str(Path(sys.executable).with_name("grader"))
_STEP = "03-circle-publisher"
_SUBMISSION = _ROOT / "solutions" / _STEP
_NODE = "my_robot_controller/draw_circle.py"


@dataclass(frozen=True)
class Row:
    """A row of the table. `value` and `aim` have the same unit. A value is good if it is at most `aim`."""

    name: str
    value: float
    unit: str
    aim: float | None = None


@dataclass(frozen=True)
class InF:
    """The wall time and the CPU time of a measurement, divided by F."""

    wall: float
    cpu: float


class Bench:
    """The measurements of one run.

    The measurements write their files to `folder`. The method `in_f` repeats each measurement `times` times.
    """

    def __init__(self, folder: Path, times: int) -> None:
        self._folder = folder
        self._times = times
        self._names = iter(range(10_000))
        self.bare: list[Cost] = []

    def new_folder(self) -> Path:
        """Return a new, empty folder."""
        folder = self._folder / str(next(self._names))
        folder.mkdir()
        return folder

    def f(self) -> Cost:
        """Measure F (see grader.benchmarks.check)."""
        parts = bare_costs(_SUBMISSION, self.new_folder()).values()
        self.bare.append(Cost(sum(one.wall_s for one in parts), sum(one.cpu_s for one in parts), 0.0))
        return self.bare[-1]

    def in_f(self, measure: Callable[[], Cost]) -> InF:
        """Measure F and call `measure` alternately. Return the medians of the ratios."""
        pairs = [(self.f(), measure()) for _ in range(self._times)]
        return InF(
            statistics.median(one.wall_s / f.wall_s for f, one in pairs),
            statistics.median(one.cpu_s / f.wall_s for f, one in pairs),
        )


def main() -> None:
    """Measure all costs and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--times", type=int, default=5, help="number of measurements, whose median is printed")
    parser.add_argument("--class", dest="students", type=int, default=16, help="size of the class (default: 16)")
    parser.add_argument("--sync", type=int, default=6, help="number of notebooks for `gradebook sync` (default: 6)")
    arguments = parser.parse_args()
    before = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(Path(folder), arguments.times)
        rows = list(_rows(bench, arguments.students, arguments.sync))
    load = f"load {before:.1f} at the start and {os.getloadavg()[0]:.1f} at the end"
    print(f"{time.strftime('%d %B %Y', time.gmtime())}, {os.cpu_count()} processors, {load}")
    wall_s, cpu_s = (statistics.median(getattr(f, key) for f in bench.bare) for key in ("wall_s", "cpu_s"))
    print(f"F = {wall_s:.2f} s wall, {cpu_s:.2f} s CPU (medians of {len(bench.bare)})\n")
    print(f"{'':44}{'measured':>9}{'target':>8}")
    for row in rows:
        aim = "" if row.aim is None else f"{row.aim:8.2f}"
        print(f"{row.name:44}{row.value:9.2f}{aim:8} {row.unit}")


def _rows(bench: Bench, students: int, notebook_students: int) -> Iterator[Row]:
    recording = bench.new_folder() / "recording"
    cost([_GRADER, "check", str(_SUBMISSION), "--clock", "simulated", "--recording", str(recording)])
    for step, most_wall, most_cpu in ((_STEP, 1.15, 1.2), ("07-challenges", 2.0, None)):
        first = bench.in_f(partial(_first_check, bench, step))
        again = _check(bench, step)
        cost(again)
        for name, checked in ((step[:2], first), (f"{step[:2]} again", bench.in_f(partial(cost, again)))):
            yield Row(f"grader check {name}, wall time", checked.wall, "F", most_wall)
            yield Row(f"grader check {name}, CPU time", checked.cpu, "F", most_cpu)
    saved = bench.in_f(lambda: Cost(_save_s(bench.new_folder()), 0.0, 0.0))
    yield Row("grader watch, from save to verdict", saved.wall, "F", 0.35)
    sizes: list[float] = []
    page = bench.in_f(lambda: _page_cost(recording, bench.new_folder() / "page.html", sizes))
    yield Row("the page of a report", page.wall, "F", 0.15)
    yield Row("the page of a report, size", sizes[-1], "KB", 250.0)
    for words in (["--help"], ["status"], ["hint", "03"]):
        seconds = statistics.median(cost([_GRADER, *words]).wall_s for _ in bench.bare)
        yield Row(f"grader {' '.join(words)}", seconds, "s", 0.10)
    begun, graded, ended = bench.f(), class_cost(bench.new_folder(), students, None, "right"), bench.f()
    yield Row(f"a class of {students}, wall time each", 2 * graded.wall_s / (begun.wall_s + ended.wall_s), "F", 0.55)
    yield Row(f"a class of {students}, CPU time each", 2 * graded.cpu_s / (begun.wall_s + ended.wall_s), "F")
    yield Row(f"a class of {students}, total memory", graded.peak_mb, "MB", 400.0)
    if notebook_students:
        synced_s = notebooks.sync_s(bench.new_folder(), notebook_students) / notebook_students
        in_f = 2 * synced_s / (ended.wall_s + bench.f().wall_s)
        yield Row(f"gradebook sync of {notebook_students}, wall time each", in_f, "F", 0.55)


def _check(bench: Bench, step: str) -> list[str]:
    """Return the command that checks a package that has not been built yet."""
    package = new_package(_ROOT / "solutions" / step, bench.new_folder() / "new")
    return [_GRADER, "check", str(package), "--exercise", step, "--clock", "simulated"]


def _first_check(bench: Bench, step: str) -> Cost:
    return cost(_check(bench, step))


def _page_cost(recording: Path, page: Path, sizes: list[float]) -> Cost:
    seconds, size_kb = page_cost(recording, page)
    sizes.append(size_kb)
    return Cost(seconds, 0.0, 0.0)


def _save_s(folder: Path) -> float:
    package = Path(shutil.copytree(_SUBMISSION / "my_robot_controller", folder / "home" / "my_robot_controller"))
    return seconds_to_verdict(package, _STEP, package / _NODE)


if __name__ == "__main__":
    main()
