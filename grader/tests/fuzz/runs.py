"""What was fuzzed so far: one file for each run in build/fuzz/TARGET/runs/, and their sums as a table.

The corpus of a target is kept, too, so that a run continues where the earlier runs have ended.
"""

from __future__ import annotations

import json
import os
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

EVERY_S = 10.0
"""How often a run is written (s), so that a run that is killed counts, too."""
_NUMBERS = ("wall_s", "cpu_s", "executions")
"""The keys of a run in its file."""


class Tally:
    """Counts the inputs of this run and the CPU time (s), and writes both to a file."""

    def __init__(self, target: Path) -> None:
        (target / "runs").mkdir(parents=True, exist_ok=True)
        self._begun, self._begun_cpu_s = time.monotonic(), time.process_time()
        self._file = target / "runs" / f"{time.strftime('%Y-%m-%dT%H-%M-%S')}-{os.getpid()}.json"
        self._written, self._executions = -EVERY_S, 0

    def count(self) -> None:
        """Count one input."""
        self._executions += 1
        now = time.monotonic()
        if now >= self._written + EVERY_S:
            self._written = now
            wall_s = round(now - self._begun, 1)
            cpu_s = round(time.process_time() - self._begun_cpu_s, 1)
            run = {"wall_s": wall_s, "cpu_s": cpu_s, "executions": self._executions}
            # The file is replaced, because a run that is killed while it writes would leave an empty file.
            new = self._file.with_suffix(".new")
            new.write_text(json.dumps(run))
            new.replace(self._file)


def table(folder: Path, targets: Iterable[str]) -> str:
    """Return the minutes of wall and CPU time and the executions of all runs of each target, as Markdown.

    A file that cannot be read is left out, and is named below the table.
    """
    unreadable: list[str] = []
    lines = ["| target | runs | minutes | minutes of CPU time | executions |", "| --- | --- | --- | --- | --- |"]
    for target in targets:
        files = sorted((folder / kept_as(target) / "runs").glob("*.json"))
        runs = [run for file in files if (run := _read(file, unreadable)) is not None]
        wall, cpu = (sum(run[what] for run in runs) / 60.0 for what in ("wall_s", "cpu_s"))
        executions = round(sum(run["executions"] for run in runs))
        lines.append(f"| `{target}` | {len(runs)} | {wall:.1f} | {cpu:.1f} | {executions:,} |")
    if unreadable:
        lines += ["", "Left out, because they cannot be read:", *(f"- {file}" for file in unreadable)]
    return "\n".join(lines)


def _read(file: Path, unreadable: list[str]) -> dict[str, float] | None:
    """Return the numbers of a run. If the file does not contain them, add it to `unreadable` and return None."""
    try:
        run = json.loads(file.read_bytes())
        return {what: float(run[what]) for what in _NUMBERS}
    except (OSError, ValueError, KeyError, TypeError):
        unreadable.append(str(file))
        return None


def kept_as(target: str) -> str:
    """Return the name of the folder of a target."""
    return target.replace(" ", "-")
