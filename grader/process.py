"""Run a child process to its end, with input, capped output and a deadline."""

from __future__ import annotations

import os
import selectors
import signal
import subprocess
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

_CHUNK = 1024 * 1024


@dataclass(frozen=True)
class Finished:
    """How a child ended. `too_much`: standard output went over its cap, and the child was ended for it."""

    exit_code: int
    stdout: bytes
    stderr: bytes
    seconds: float
    timed_out: bool = False
    too_much: bool = False


class _Tail:
    """The first and the last half of what may be kept: a log's beginning and its end say most."""

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
    """The child's three pipes, all served at once, so that none can block another."""

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

    def serve(self, deadline: float) -> bool:
        """Serve until the child has closed its pipes or written too much; false at the deadline (monotonic, s)."""
        with self._selector:
            while self._selector.get_map() and not self.too_much:
                left_s = deadline - time.monotonic()
                if left_s <= 0:
                    return False
                for key, _ in self._selector.select(left_s):
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
) -> Finished:
    """Run `argv` in a session of its own; of standard error, beginning and end are kept (bytes)."""
    begun = time.monotonic()
    pipe = subprocess.PIPE
    with subprocess.Popen(argv, stdin=pipe, stdout=pipe, stderr=pipe, env=env, start_new_session=True) as child:
        pump = _Pump(child, stdin, most_stdout, most_stderr)
        in_time = False
        try:
            in_time = pump.serve(begun + timeout_s)
            child.wait(max(0.0, begun + timeout_s - time.monotonic()))
        except subprocess.TimeoutExpired:
            in_time = False
        finally:
            if not in_time or pump.too_much:
                os.killpg(child.pid, signal.SIGKILL)
    seconds = time.monotonic() - begun
    return Finished(child.returncode, bytes(pump.stdout), pump.stderr.text(), seconds, not in_time, pump.too_much)
