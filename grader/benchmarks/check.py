"""Measure the cost of `grader check` relative to F, the time of a `colcon build` plus a process with one rclpy node.

    python -m grader.benchmarks.check [--times N] [--submission FOLDER]

Everything is measured in one run on the same machine. The measurements alternate, so that other programs slow down all
of them alike. The first check of a package builds the package. The next check reuses the build, as does a check after a
change to a module.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import tempfile
from pathlib import Path

from grader.benchmarks.bare import bare_costs, new_package
from grader.benchmarks.measure import Cost, cost

_ROOT = Path(__file__).resolve().parents[2]
_GRADER = str(Path(sys.executable).with_name("grader"))


def main() -> None:
    """Measure the cost of each part, and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--times", type=int, default=5, help="number of measurements, whose median is printed")
    parser.add_argument("--submission", type=Path, default=_ROOT / "solutions/03-circle-publisher")
    arguments = parser.parse_args()
    costs: dict[str, list[Cost]] = {}
    stages: dict[str, list[float]] = {}
    for _ in range(arguments.times):
        with tempfile.TemporaryDirectory() as folder:
            for name, measured in _round(arguments.submission, Path(folder), stages).items():
                costs.setdefault(name, []).append(measured)
    _print(costs, stages)


def _round(submission: Path, folder: Path, stages: dict[str, list[float]]) -> dict[str, Cost]:
    report = folder / "report.json"
    package = new_package(submission, folder / "new" / submission.name)
    check = [_GRADER, "check", str(package), "--exercise", submission.name, "--json", str(report)]
    measured = {
        **bare_costs(submission, folder),
        "check, simulated": cost([*check, "--clock", "simulated"]),
    }
    for stage, seconds in json.loads(report.read_text())["seconds"].items():
        stages.setdefault(stage, []).append(seconds)
    measured["next check, simulated"] = cost([*check, "--clock", "simulated"])
    measured["check, wall"] = cost([*check, "--clock", "wall"])
    measured["grader --help"] = cost([_GRADER, "--help"])
    return measured


def _print(costs: dict[str, list[Cost]], stages: dict[str, list[float]]) -> None:
    middle = {
        name: Cost(*(statistics.median(getattr(c, key) for c in of) for key in ("wall_s", "cpu_s", "peak_mb")))
        for name, of in costs.items()
    }
    f_s = middle["colcon build"].wall_s + middle["rclpy node"].wall_s
    print(f"F = {f_s:.2f} s wall (medians of {len(costs['colcon build'])})\n")
    print(f"{'':22}{'wall s':>8}{'wall F':>8}{'CPU s':>8}{'CPU F':>8}{'peak MB':>9}")
    for name, one in middle.items():
        figures = (one.wall_s, one.wall_s / f_s, one.cpu_s, one.cpu_s / f_s)
        print(f"{name:22}" + "".join(f"{figure:8.2f}" for figure in figures) + f"{one.peak_mb:9.0f}")
    print("\nshare of a simulated check")
    whole = statistics.median(stages.pop("in all"))
    trial = statistics.median(stages.pop("trial"))
    for stage, seconds in stages.items():
        print(f"{stage:20}{statistics.median(seconds):8.2f}{statistics.median(seconds) / whole:8.0%}")
    print(f"{'(whole trial)':20}{trial:8.2f}{trial / whole:8.0%}")
    print(f"{'in all':20}{whole:8.2f}")


if __name__ == "__main__":
    main()
