"""Measure how long `grader watch` takes from save to verdict, relative to F: a `colcon build` plus an rclpy node.

    python -m grader.benchmarks.watch [--times N] [--submission FOLDER --exercise NAME --file PATH]

The benchmark runs `grader watch` in a pseudo-terminal. The time is measured from the save until the line after the
verdict appears. F and `grader watch` are measured alternately in the same run, so that other programs slow down both.
"""

from __future__ import annotations

import argparse
import os
import shutil
import statistics
import sys
import tempfile
import time
from pathlib import Path

import pexpect

from grader.benchmarks.bare import bare_costs

_ROOT = Path(__file__).resolve().parents[2]
_GRADER = str(Path(sys.executable).with_name("grader"))
_STEP = "03-circle-publisher"
_FILE = "my_robot_controller/draw_circle.py"
_PATIENCE_S = 300
_REST_S = 2.0
"""The pause before the save (s), since a learner also pauses. In this time, `grader watch` prepares the next trial."""


def main() -> None:
    """Measure everything and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--times", type=int, default=5, help="number of saves, whose median time is printed")
    parser.add_argument("--submission", type=Path, default=_ROOT / "solutions" / _STEP / "my_robot_controller")
    parser.add_argument("--exercise", default=_STEP)
    parser.add_argument("--file", default=_FILE, help="the file to save, relative to the submission")
    arguments = parser.parse_args()
    bare, saves = [], []
    for _ in range(arguments.times):
        with tempfile.TemporaryDirectory() as folder:
            package = Path(shutil.copytree(arguments.submission, Path(folder) / "home" / arguments.submission.name))
            saves.append(seconds_to_verdict(package, arguments.exercise, package / arguments.file))
            # Measure F only now, because `cost` waits until all children of this process exit.
            scratch = Path(folder) / "bare"
            scratch.mkdir()
            bare.append(sum(each.wall_s for each in bare_costs(package, scratch).values()))
    f_s, save_s = statistics.median(bare), statistics.median(saves)
    print(f"F = {f_s:.2f} s wall (median of {len(bare)})")
    print(f"save to verdict {save_s:.2f} s = {save_s / f_s:.2f} F, worst {max(saves) / f_s:.2f} F")


def seconds_to_verdict(package: Path, exercise: str, file: Path) -> float:
    """Watch the package, save the file with a new comment, and return the time from save to verdict (s)."""
    env = {
        **os.environ,
        "HOME": str(package.parent),
        "XDG_CACHE_HOME": os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache"),
        "TERM": "xterm",
    }
    screen = pexpect.spawn(
        _GRADER,
        ["watch", str(package), "--exercise", exercise],
        env=env,
        encoding="utf-8",
        timeout=_PATIENCE_S,
        dimensions=(60, 110),
    )
    screen.delaybeforesend = None
    screen.expect("Watching")
    time.sleep(_REST_S)
    begun = time.monotonic()
    file.write_text(f"{file.read_text(encoding='utf-8')}# a remark\n", encoding="utf-8")
    screen.expect("Watching")
    seconds = time.monotonic() - begun
    screen.send("q")
    screen.expect(pexpect.EOF)
    screen.close()
    return seconds


if __name__ == "__main__":
    main()
