"""Run a child process until it exits, with input, limited output and a deadline."""

from __future__ import annotations

import os
import selectors
import signal
import subprocess
import time
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.sandbox.usage import EVERY_S, Guard

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from grader.sandbox.limits import Limits

_CHUNK = 1024 * 1024
MOST_TIME = 3
"""The maximum duration of a watched child process, as a multiple of its time limit."""


@dataclass(frozen=True)
class Finished:
    """The result of a child process.

    `too_much` is True if the process was stopped because it wrote too much standard output. `out_of` is the limit of
    `watch` that the process and its descendants exceeded, or None.
    """

    exit_code: int
    stdout: bytes
    stderr: bytes
    seconds: float
    timed_out: bool = False
    too_much: bool = False
    out_of: str | None = None


class _Tail:
    """Keeps the beginning and the end of an output, which are the most useful parts of a log.

    Each of the two parts has at most half of the maximum size.
    """

    def __init__(self, most: int) -> None:
        self._half = most // 2
        self._head = bytearray()
        self._tail = bytearray()
        self._dropped = 0

    def add(self, data: bytes) -> None:
        room = self._half - len(self._head)
        self._head += data[:room]
        self._tail += data[room:]
        if len(self._tail) > 2 * self._half:
            self._drop()

    def text(self) -> bytes:
        self._drop()
        gap = b"\n... %d bytes left out ...\n" % self._dropped if self._dropped else b""
        return bytes(self._head) + gap + bytes(self._tail)

    def _drop(self) -> None:
        over = len(self._tail) - self._half
        if over > 0:
            self._dropped += over
            del self._tail[:over]


class _Pump:
    """The three pipes of a child process, served together so that a full pipe does not block another pipe."""

    def __init__(self, child: subprocess.Popen[bytes], stdin: bytes, most_stdout: int, most_stderr: int) -> None:
        assert child.stdin is not None
        assert child.stdout is not None
        assert child.stderr is not None
        self.stdout = bytearray()
        self.stderr = _Tail(most_stderr)
        self._most = most_stdout
        self._rest = memoryview(stdin)
        self._selector = selectors.DefaultSelector()
        os.set_blocking(child.stdin.fileno(), False)
        self._selector.register(child.stdin, selectors.EVENT_WRITE, self._feed)
        self._selector.register(child.stdout, selectors.EVENT_READ, self._take(self.stdout.extend))
        self._selector.register(child.stderr, selectors.EVENT_READ, self._take(self.stderr.add))

    @property
    def too_much(self) -> bool:
        return len(self.stdout) > self._most

    def serve(self, left: Callable[[], float], stopped: Callable[[], bool]) -> bool:
        """Serve the pipes until the child closes them or writes too much.

        Return False if the time runs out first, or if `stopped` returns True first. `left` returns the remaining time
        (s). `left` and `stopped` are called several times per second.
        """
        with self._selector:
            while self._selector.get_map() and not self.too_much:
                left_s = left()
                if left_s <= 0 or stopped():
                    return False
                for key, _ in self._selector.select(min(left_s, EVERY_S)):
                    if not key.data(key.fd):
                        self._selector.unregister(key.fileobj)
                        key.fileobj.close()  # type: ignore[union-attr]
        return True

    def _feed(self, fd: int) -> bool:
        try:
            self._rest = self._rest[os.write(fd, self._rest[:_CHUNK]) :]
        except BrokenPipeError:
            return False
        return len(self._rest) > 0

    @staticmethod
    def _take(keep: Callable[[bytes], None]) -> Callable[[int], bool]:
        def take(fd: int) -> bool:
            data = os.read(fd, _CHUNK)
            keep(data)
            return bool(data)

        return take


def run(
    argv: Sequence[str],
    *,
    stdin: bytes = b"",
    env: Mapping[str, str] | None = None,
    timeout_s: float,
    most_stdout: int,
    most_stderr: int,
    pass_fds: Sequence[int] = (),
    watch: Limits | None = None,
) -> Finished:
    """Run the command `argv` in a new session until the command exits.

    The command is killed if it runs for longer than `timeout_s` (s), or if it writes more than `most_stdout` bytes to
    standard output. Of standard error, the beginning and the end are kept, together at most `most_stderr` bytes.

    With `watch`, the child is killed when it and its descendants together exceed these limits. The time for which these
    processes wait for a processor does not count. On a crowded machine, the child may take up to MOST_TIME times
    `timeout_s`. The total CPU time of its processes is also limited to `timeout_s`, so that they gain no time by
    keeping the processors busy.

        done = run(["cat"], stdin=b"text", timeout_s=60.0, most_stdout=1000, most_stderr=1000)
    """
    begun = time.monotonic()
    pipe = subprocess.PIPE
    over: list[str] = []
    with subprocess.Popen(
        argv, stdin=pipe, stdout=pipe, stderr=pipe, env=env, start_new_session=True, pass_fds=pass_fds
    ) as child:
        pump = _Pump(child, stdin, most_stdout, most_stderr)
        guard = Guard([child.pid], watch, over.append) if watch is not None else None

        def left() -> float:
            now = time.monotonic()
            if guard is None:
                return begun + timeout_s - now
            if guard.worked_s(begun, now) >= timeout_s:
                return 0.0
            return begun + timeout_s + min(guard.waited_s(), (MOST_TIME - 1) * timeout_s) - now

        in_time = False
        try:
            in_time = pump.serve(left, lambda: bool(over))
            if in_time and not pump.too_much:
                child.wait(max(0.0, left()))
        except subprocess.TimeoutExpired:
            in_time = False
        finally:
            if not in_time or pump.too_much:
                with suppress(ProcessLookupError):
                    os.killpg(child.pid, signal.SIGKILL)
            if guard is not None:
                guard.close()
    seconds = time.monotonic() - begun
    out_of = over[0] if over else None
    timed_out = not in_time and not over
    return Finished(child.returncode, bytes(pump.stdout), pump.stderr.text(), seconds, timed_out, pump.too_much, out_of)
