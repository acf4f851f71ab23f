"""The process of the student's node: start it through a launcher, keep its output, and stop it as with Ctrl-C."""

from __future__ import annotations

import fcntl
import json
import os
import signal
import subprocess
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.process_stat import has_exited, stat_fields
from grader.sandbox.usage import Guard
from grader.trial.launchers import await_launcher
from grader.trial.recording import Output, ProcessEnd

if TYPE_CHECKING:
    from grader.sandbox.limits import Limits
    from grader.trial.launchers import Launcher

KEPT = 256 * 1024
"""The maximum number of bytes that are kept from each output stream."""
PIPE = 1024 * 1024
"""The size (bytes) that the grader requests for the node's pipes. The size is large, so that the node need not wait
until the grader has read its output."""
FULL = 0.25
"""If a node wrote less than this share of the pipe's size, the pipe was never full, so the node did not have to wait.
The share is small, because the kernel may leave half of each page of the pipe empty."""
STOP_S = 3.0
"""The maximum time that the node may take to exit after SIGINT (s). After this time, the grader sends SIGTERM and, 1 s
later, SIGKILL. The time for which the node waits for a processor does not count."""
MOST_WAITED_S = 12.0
"""The maximum time (s) that is subtracted from a node's time to exit, because the node waited for a processor."""
_REPORTED_S = 30.0
"""The maximum time to wait for the exit code of a process that has exited (s)."""
MOST_GAP_S = 0.25
"""The maximum time (s) between two observations of a node that counts as its time to exit. If the grader itself, or the
whole machine, was paused for longer, the node is not to blame, and may have exited long before this was noticed."""


def enlarge(pipe: int) -> int:
    """Make a pipe as large as the kernel allows, up to PIPE, and return its size (bytes).

    The kernel refuses a size if it would make the user's pipes too large in total (fs.pipe-user-pages-soft, see
    pipe(7)).
    """
    size = PIPE
    while size > (given := fcntl.fcntl(pipe, fcntl.F_GETPIPE_SZ)):
        with suppress(OSError):
            return fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, size)
        size //= 2
    return given


@dataclass
class Stream:
    """The output that was read from one pipe, and the time (s) at which each line began."""

    fd: int
    kept: bytearray = field(default_factory=bytearray)
    times: list[float] = field(default_factory=list)
    dropped: int = 0

    def read(self, now_s: float) -> int:
        """Read available output, and return the number of bytes."""
        size = 0
        for _ in range(64):
            try:
                chunk = os.read(self.fd, PIPE)
            except BlockingIOError:
                return size
            if not chunk:
                return size
            size += len(chunk)
            room = KEPT - len(self.kept)
            taken = chunk[:room]
            starts_line = not self.kept or self.kept.endswith(b"\n")
            self.times += [now_s] * (taken.count(b"\n", 0, -1) + starts_line if taken else 0)
            self.kept += taken
            self.dropped += len(chunk) - len(taken)
        return size

    def output(self) -> Output:
        """Return the output in the form that is stored in a recording."""
        return Output(self.kept.decode("utf-8", "replace"), self.dropped, tuple(self.times))


class NodeProcess:
    """The process of a node with its pipes, as a context manager.

    On exit, the manager kills the process and, in a cell, all other processes of the cell.
    """

    def __init__(self, launcher: Launcher, limits: Limits) -> None:
        """Use a launcher that has been started. The `limits` apply to all processes of the node together."""
        self._launcher = launcher
        self._limits = limits
        self._guard: Guard | None = None
        self._out_of: str | None = None
        self._streams = [Stream(launcher.stdout.fileno()), Stream(launcher.stderr.fileno())]
        self._full = FULL * min(enlarge(stream.fd) for stream in self._streams)
        self.pid = 0
        self.pause_address = 0
        """The address of the pause (launcher.publish_pauses) in the memory of the process."""
        self._observed: float | None = None
        """After SIGINT: the time of CLOCK_MONOTONIC at which `_stopping_s` was last called (s)."""
        self._passed_s = 0.0
        self._waited_before_s = 0.0
        self._took_s: float | None = None
        """The time (s) from SIGINT until the exit of the process was noticed, as `_stopping_s` measured it."""
        self._by = "itself"
        self._processes: tuple[int, ...] = ()

    def __enter__(self) -> NodeProcess:  # noqa: PYI034 - typing.Self is Python 3.11's
        return self

    def __exit__(self, *_: object) -> None:
        if self._guard is not None:
            self._guard.close()
        self._launcher.close()

    def await_ready(self) -> None:
        """Wait until the launcher is ready to receive the data about its node.

        Raises:
            LaunchError: the launcher exited.
        """
        self._processes = self._launcher.await_started()
        self.pid = self._processes[0]
        self.pause_address = await_launcher(self._launcher.stdout, self._launcher.stderr)
        for stream in self._streams:
            os.set_blocking(stream.fd, False)

    def start(self, order: dict[str, object], tree: bytes) -> None:
        """Send the launcher the install tree and the data about its node."""
        # Do not start the guard earlier: a launcher may wait for minutes, and watching it takes 1 % of a core.
        self._guard = Guard(self._processes, self._limits, self._over, in_room=self._launcher.in_cell)
        try:
            self._launcher.stdin.write(json.dumps(order).encode() + b"\n" + tree)
            self._launcher.stdin.close()
        except BrokenPipeError:
            pass  # the launcher has exited: see `ended`

    def worked_s(self, begin: float, end: float) -> float:
        """Return the CPU time that all processes of the node used between two times of CLOCK_MONOTONIC (s)."""
        return self._guard.worked_s(begin, end) if self._guard is not None else 0.0

    def started_ready_s(self) -> float:
        """Return the total time (s) for which the processes started by the node ran or waited for a processor."""
        return self._guard.ready_s(but=self.pid) if self._guard is not None else 0.0

    def has_started_others(self) -> bool:
        """Return whether a process that the node started is running, as far as this was observed."""
        return self._guard is not None and self._guard.has_others()

    def read_output(self, now_s: float) -> int:
        """Read and store the node's new output with the arrival time `now_s`, and return the number of bytes."""
        return sum(stream.read(now_s) for stream in self._streams)

    def waited_to_write(self, size: int) -> bool:
        """Return whether a full pipe might have delayed a node that wrote this many bytes."""
        return size >= self._full

    def output(self) -> tuple[Output, Output]:
        """Return the standard output and the standard error that the node has written."""
        return self._streams[0].output(), self._streams[1].output()

    def ended(self) -> bool:
        """Return whether the process has exited."""
        if self._launcher.poll() is None:
            return False
        if self._took_s is None:
            self._took_s = self._stopping_s()
        return True

    @property
    def ended_itself(self) -> bool:
        """True until the scenario is over, even if the node is killed because it exceeds a limit."""
        return self._by == "itself"

    def scenario_is_over(self) -> None:
        """Let a later exit count as caused by the end of the scenario, even if it comes before SIGINT.

        For example, a node may exit because another node, which was stopped first, no longer answers.
        """
        if self._is_gone():
            # The node has just exited on its own, and its exit code is about to be reported.
            with suppress(subprocess.TimeoutExpired):
                self._launcher.wait(_REPORTED_S)
        if not self.ended():
            self._by = "SIGINT"

    def interrupt(self) -> None:
        """Send SIGINT, as Ctrl-C does in a terminal."""
        self.scenario_is_over()
        if not self.ended():
            self._observed = time.monotonic()
            self._waited_before_s = self._waited_s()
            self._signal(signal.SIGINT)

    def escalate(self) -> None:
        """Send SIGTERM, and later SIGKILL, if the node does not exit in time.

        Call this method repeatedly after SIGINT.
        """
        passed = self._stopping_s()
        assert passed is not None
        if passed > STOP_S + 1.0 and self._by != "SIGKILL":
            self._by = "SIGKILL"
            self._launcher.kill()  # in a cell, this ends all processes of the cell
            self._signal(signal.SIGKILL)
        elif passed > STOP_S and self._by == "SIGINT":
            self._by = "SIGTERM"
            self._signal(signal.SIGTERM)

    @property
    def lost(self) -> bool:
        """Whether the process has ended because a process of the grader was killed. The node is not the cause."""
        return self._launcher.lost

    def end(self, now_s: float) -> ProcessEnd:
        """Return how the process of the node ended. Call this method only after `ended` has returned True."""
        return ProcessEnd(self._by, self._launcher.poll(), now_s, self._took_s, self._out_of)  # type: ignore[arg-type]

    def _stopping_s(self) -> float | None:
        """Return the time since SIGINT (s), minus the time for which the node waited for a processor.

        Before SIGINT, return None or, if the scenario is over, 0.
        """
        if self._observed is None:
            return None if self.ended_itself else 0.0
        now = time.monotonic()
        self._passed_s += min(now - self._observed, MOST_GAP_S)
        self._observed = now
        waited_s = self._waited_s() - self._waited_before_s
        return max(0.0, self._passed_s - min(waited_s, MOST_WAITED_S))

    def _waited_s(self) -> float:
        return self._guard.waited_s(of=self.pid) if self._guard is not None else 0.0

    def _over(self, what: str) -> None:
        self._out_of = what
        self._launcher.kill()  # in a cell, this ends all processes of the cell

    def _is_gone(self) -> bool:
        try:
            stat = Path(f"/proc/{self.pid}/stat").read_bytes()
        except OSError:
            return True
        return has_exited(stat_fields(stat))

    def _signal(self, number: int) -> None:
        try:
            group = os.getpgid(self.pid)
            if group == os.getpgid(0):
                os.kill(self.pid, number)  # the launcher has not created its process group yet
            else:
                os.killpg(group, number)
        except ProcessLookupError:
            pass
