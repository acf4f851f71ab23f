"""Measure the cost of reading a submission in child processes relative to reading it in the same process.

    python -m grader.benchmarks.reading [--times N] [--submission FOLDER]

The submission is graded once. After that, the files of the submission are read repeatedly, alternately in child
processes and in the process of the benchmark. The limit of this benchmark applies to CPU time, because CPU time depends
less on the load of the machine than wall time does.
"""

from __future__ import annotations

import argparse
import dataclasses
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from grader.benchmarks.bare import bare_costs
from grader.checks.exercises import load_exercise
from grader.errors import MachineError
from grader.evidence import recording_format
from grader.exercise.model import course_folder
from grader.grading.judging import Judging
from grader.submission import reader
from grader.submission.package import open_submission

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

_GRADER = str(Path(sys.executable).with_name("grader"))
_MOST_S = 0.04
"""The maximum cost (CPU time in s)."""


def main() -> None:
    """Measure everything and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--times", type=int, default=20, help="number of measurements, whose median is printed")
    parser.add_argument("--submission", type=Path, default=course_folder().parent / "solutions/03-circle-publisher")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bare = bare_costs(args.submission, Path(folder))
        kept = Path(folder) / "recording"
        argv = [_GRADER, "check", str(args.submission), "--recording", str(kept)]
        subprocess.run(argv, check=True, capture_output=True)
        evidence = recording_format.load(kept, load_exercise).evidence
    costs: dict[bool, list[tuple[float, float]]] = {True: [], False: []}
    for turn in range(2 * (args.times + 1)):
        inside = reader._Child.inside = bool(turn % 2)
        before = _now()
        _read(args.submission, evidence)
        if turn > 1:  # the first measurement includes late imports
            after = _now()
            costs[inside].append((after[0] - before[0], after[1] - before[1]))
    wall_s, cpu_s = (
        statistics.median(one[kind] for one in costs[False]) - statistics.median(one[kind] for one in costs[True])
        for kind in (0, 1)
    )
    f_s = bare["colcon build"].wall_s + bare["rclpy node"].wall_s
    print(f"F = {f_s:.2f} s wall")
    print(f"reading in children: {1000 * wall_s:+.0f} ms, {wall_s / f_s:+.3f} F, {1000 * cpu_s:+.0f} ms of CPU")
    if cpu_s > _MOST_S:
        message = f"Reading in child processes costs more than {1000 * _MOST_S:.0f} ms of CPU time, the limit."
        raise MachineError(message)


def _read(submission: Path, evidence: Evidence) -> None:
    """Read what `grader check` reads from the submission, in the same steps."""
    judging = Judging("auto")
    opened = open_submission(submission)
    files = dataclasses.replace(evidence, submission=opened, build=None, runs={})
    judging.early(files)
    built = dataclasses.replace(files, build=evidence.build)
    judging.so_far(built, {})
    judging.so_far(dataclasses.replace(built, runs=evidence.runs), {})


def _now() -> tuple[float, float]:
    """Return the wall time, and the CPU time of this process and its children (s)."""
    times = os.times()
    return time.monotonic(), times.user + times.system + times.children_user + times.children_system


if __name__ == "__main__":
    main()
