"""Measure a command: its wall time, its CPU time including all descendants, and its peak memory without descendants."""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.benchmarks.cpu_group import cpu_group
from grader.common.linux_calls import adopt_orphans

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence


@dataclass(frozen=True)
class Cost:
    """The wall and CPU time of a command with all its descendants (s), and the peak memory of the command (MB)."""

    wall_s: float
    cpu_s: float
    peak_mb: float


def cost(argv: Sequence[str], *, env: Mapping[str, str] | None = None, cwd: Path | None = None) -> Cost:
    """Run a command until it exits, and return its cost.

    Without a control group, the CPU time does not include the processes that were still running when their sandbox cell
    ended.

    Raises:
        RuntimeError: the command failed.
    """
    adopt_orphans()  # so that the orphans of a sandbox are also counted
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    # The output goes to a file, because a command that fills a pipe would wait for a reader.
    with cpu_group() as group, tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as output:
        begun = time.monotonic()
        with subprocess.Popen(group.joined(argv), env=env, cwd=cwd, stdout=output, stderr=subprocess.STDOUT) as child:
            peak_mb = 0.0
            while child.poll() is None:
                peak_mb = max(peak_mb, _peak_mb(child.pid))
                _reap_orphans(child.pid)
                time.sleep(0.02)
            wall_s = time.monotonic() - begun
        with suppress(ChildProcessError):
            while True:
                os.waitpid(-1, 0)
        group.wait()
        counted_s = group.cpu_s()
        output.seek(0)
        said = output.read()
    if child.returncode != 0:
        message = f"{' '.join(argv)} exited with code {child.returncode}:\n{said}"
        raise RuntimeError(message)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    waited_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Cost(wall_s, waited_s if counted_s is None else counted_s, peak_mb)


def median(run: Callable[[], Cost], times: int) -> Cost:
    """Call `run` `times` times. Return the median of each value."""
    costs = [run() for _ in range(times)]
    return Cost(*(statistics.median(getattr(c, name) for c in costs) for name in ("wall_s", "cpu_s", "peak_mb")))


def _reap_orphans(child: int) -> None:
    """Reap the adopted processes that have exited. There are thousands of them in a large class."""
    with suppress(ChildProcessError):
        while (exited := os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)) and exited.si_pid != child:
            os.waitpid(exited.si_pid, 0)


def _peak_mb(pid: int) -> float:
    try:
        for line in Path(f"/proc/{pid}/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 1024
    except (FileNotFoundError, ProcessLookupError):
        pass
    return 0.0


def cpu_s(pid: int) -> float:
    """Return the CPU time that a running process has used, excluding its children (s)."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
