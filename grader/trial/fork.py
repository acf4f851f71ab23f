"""A process that a fork server has forked (grader.trial.fork_server)."""

from __future__ import annotations

import os
import select
import signal
import socket
import struct
import subprocess
from contextlib import suppress
from threading import Lock

from grader.common.linux_calls import pidfd_send_signal
from grader.sandbox import entering

STARTED = b"s"
"""The message with which the fork server sends a descriptor of the new process (pidfd_open(2))."""
STATUS = struct.Struct("<i")
"""The message that the fork server sends when the process has ended: the exit code, or a negative signal number."""


class Fork:
    """A process that a fork server has forked, or will fork, with methods like those of `subprocess.Popen`."""

    def __init__(self, result: socket.socket) -> None:
        """Watch the forked process. Its fork server has the other end of the socket `result`."""
        self.returncode: int | None = None
        self.lost = False
        """Whether the process has ended, but its exit code never arrived (see `wait`)."""
        self._result = result
        self._process: int | None = None
        self._starting = Lock()

    def close(self) -> None:
        """Stop watching. The fork server then kills the process if it is still running. Any thread may call this."""
        with suppress(OSError):  # the fork server has exited
            self._result.shutdown(socket.SHUT_RDWR)  # another thread may be waiting for the process
        with self._starting:
            self._result.close()
            if self._process is not None:
                os.close(self._process)
                self._process = None

    def await_started(self) -> int | None:
        """Wait until the process exists.

        Return its process id, or None if it has exited, could not be started, or is no longer watched.
        """
        with self._starting:
            if self._process is None and self._result.fileno() >= 0:
                data, passed, *_ = socket.recv_fds(self._result, 1, 1)
                if data == STARTED and passed:
                    self._process = passed[0]
            with suppress(ProcessLookupError):
                return None if self._process is None else entering.pid_of(self._process)
        return None

    def signal(self, number: int) -> None:
        """Send a signal to the process if it has not exited."""
        self.await_started()
        with self._starting, suppress(ProcessLookupError):
            if self._process is not None:
                pidfd_send_signal(self._process, number)

    def poll(self) -> int | None:
        """Return the exit code, or None if the process has not exited."""
        with suppress(subprocess.TimeoutExpired):
            return self.wait(0.0)
        return None

    def wait(self, timeout: float | None = None) -> int:
        """Wait until the process has exited, and return its exit code.

        If no exit code arrives, return -SIGKILL. For example, the fork server was killed, or the process could not
        enter the sandbox.

        Raises:
            subprocess.TimeoutExpired: the process did not exit within `timeout` (s).
        """
        if self.returncode is None:
            self.await_started()
            waiting = select.poll()
            waiting.register(self._result, select.POLLIN)
            if not waiting.poll(None if timeout is None else timeout * 1000.0):
                raise subprocess.TimeoutExpired([], timeout or 0.0)
            data = self._result.recv(STATUS.size)
            self.lost = len(data) != STATUS.size
            self.returncode = -signal.SIGKILL if self.lost else STATUS.unpack(data)[0]
        return self.returncode
