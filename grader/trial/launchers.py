"""Start a launcher (grader.trial.launcher): as a fork in a new cell, or as a process without a cell."""

from __future__ import annotations

import os
import re
import socket
import subprocess
from abc import ABC, abstractmethod
from contextlib import suppress
from typing import IO, TYPE_CHECKING

from grader.sandbox import bubblewrap, entering
from grader.sandbox.entering import HOLDER
from grader.sandbox.holder import Holder, HolderError
from grader.sandbox.system_calls import call_filter
from grader.trial.fork import Fork

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.sandbox.limits import Limits


_READY = re.compile(rb"\x00ready (\d+)\n\Z")
"""The launcher writes this output when it is ready, before any of the student's code runs. The number is the address
of the pause (launcher.publish_pauses)."""
_PLAIN = {"PATH": "/usr/bin:/bin"}
_NO_FORKS = "the process of the grader that forks nodes has exited"
_ENDS_S = 5.0


class LaunchError(Exception):
    """The launcher itself failed. The machine is considered the cause, since none of the student's code has run."""


def await_launcher(stdout: IO[bytes], stderr: IO[bytes] | None = None) -> int:
    """Wait until a launcher is ready to receive the data about its node. Return the address of its pause.

    Raises:
        LaunchError: the launcher exited. The message is the output of the launcher, if any.
    """
    received = b""
    while (ready := _READY.search(received)) is None:
        # Read single bytes, because the following output is that of the node.
        byte = os.read(stdout.fileno(), 1)
        if not byte:
            output = received + (stderr.read() if stderr is not None else b"")
            raise LaunchError(output.decode("utf-8", "replace").strip() or "the launcher printed nothing")
        received += byte
    return int(ready[1])


class Launcher(ABC):
    """The process of a launcher, which becomes a node, and the pipes of this process."""

    stdin: IO[bytes]
    stdout: IO[bytes]
    stderr: IO[bytes]
    in_cell: bool

    @property
    def lost(self) -> bool:
        """Whether the process has ended because a process of the grader, its ancestor, was killed."""
        return False

    @abstractmethod
    def await_started(self) -> tuple[int, ...]:
        """Wait until the process exists.

        Return its process id. For a cell, also return the process id of bubblewrap, which is an ancestor of all
        orphaned processes in the cell.

        Raises:
            LaunchError: the process could not be started.
        """

    @abstractmethod
    def poll(self) -> int | None:
        """Return the exit code, or None if the process has not exited."""

    @abstractmethod
    def wait(self, timeout: float) -> int:
        """Wait until the process has exited, and return its exit code.

        Raises:
            subprocess.TimeoutExpired: the process did not exit within `timeout` (s).
        """

    @abstractmethod
    def kill(self) -> None:
        """Kill the process and, in a cell, all other processes of the cell."""

    @abstractmethod
    def close(self) -> None:
        """Kill the processes, and wait until they have exited."""


class LauncherProcess(Launcher):
    """A launcher without a cell."""

    in_cell = False

    def __init__(self, argv: Sequence[str]) -> None:
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(argv, stdin=pipe, stdout=pipe, stderr=pipe)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        assert self._process.stderr is not None
        self.stdin, self.stdout, self.stderr = self._process.stdin, self._process.stdout, self._process.stderr

    def await_started(self) -> tuple[int, ...]:
        """Return the id of the process."""
        return (self._process.pid,)

    def poll(self) -> int | None:
        """Return the exit code, or None if the process has not exited."""
        return self._process.poll()

    def wait(self, timeout: float) -> int:
        """Wait until the process has exited, and return its exit code."""
        return self._process.wait(timeout)

    def kill(self) -> None:
        """Kill the process."""
        self._process.kill()

    def close(self) -> None:
        """Kill the process, and wait for it."""
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()


class LauncherInCell(Launcher):
    """A launcher that is a fork (grader.trial.fork_server) in a new cell."""

    in_cell = True

    def __init__(self, view: bubblewrap.View, limits: Limits, nodes: socket.socket) -> None:
        """Create the cell, and request a fork through the socket `nodes`.

        Raises:
            LaunchError: bubblewrap could not create the cell, or no process is left that forks nodes.
        """
        with call_filter() as filter_fd:
            self._cell = Holder(
                lambda info_fd: bubblewrap.cell(
                    *(HOLDER, view),
                    env=_PLAIN,
                    limits=limits,
                    network=True,
                    info_fd=info_fd,
                    filter_fd=filter_fd,
                    first=True,
                ),
                () if filter_fd is None else (filter_fd,),
            )
        try:
            process = self._cell.await_ready()
        except HolderError as error:
            self._cell.close()
            raise LaunchError(str(error)) from error
        pipes = [os.pipe(), os.pipe(), os.pipe()]
        (its_stdin, stdin), (stdout, its_stdout), (stderr, its_stderr) = pipes
        self.stdin = os.fdopen(stdin, "wb")
        self.stdout, self.stderr = os.fdopen(stdout, "rb", buffering=0), os.fdopen(stderr, "rb", buffering=0)
        result, its_result = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        passed = [process, its_stdin, its_stdout, its_stderr, its_result.detach()]
        try:
            entering.pass_descriptors(nodes, b".", passed)
        except (BrokenPipeError, ConnectionResetError) as error:
            self._cell.close()
            raise LaunchError(_NO_FORKS) from error
        finally:
            for descriptor in passed:
                os.close(descriptor)
        self._fork = Fork(result)

    @property
    def lost(self) -> bool:
        """Whether the process has ended because a process of the grader, its ancestor, was killed."""
        return self._fork.lost

    def await_started(self) -> tuple[int, ...]:
        """Wait until the process has been forked. Return its process id, and the process id of bubblewrap."""
        pid = self._fork.await_started()
        if pid is None:
            raise LaunchError(self.stderr.read().decode("utf-8", "replace").strip() or "the launcher was not forked")
        return (pid, self._cell.pid)

    def poll(self) -> int | None:
        """Return the exit code, or None if the process has not exited."""
        return self._fork.poll()

    def wait(self, timeout: float) -> int:
        """Wait until the process has exited, and return its exit code."""
        return self._fork.wait(timeout)

    def kill(self) -> None:
        """Kill all processes of the cell."""
        self._cell.kill()

    def close(self) -> None:
        """Kill all processes of the cell, and wait for them."""
        self._cell.close()
        with suppress(subprocess.TimeoutExpired):
            self._fork.wait(_ENDS_S)
        self._fork.close()
