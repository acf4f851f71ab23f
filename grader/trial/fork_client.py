"""Request conductors and nodes from the fork servers (grader.trial.fork_server)."""

from __future__ import annotations

import atexit
import json
import os
import select
import socket
import subprocess
from contextlib import suppress
from functools import cache, partial
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Any, Literal

from grader.common.interpreter import interpreter
from grader.common.loader import loaded
from grader.ros import installation
from grader.sandbox import entering
from grader.trial.fork import Fork

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

CONDUCTORS = {"ROS_PYTHON_CHECK_FIELDS": "0"}
"""Environment variables only for conductors. They disable the check of the values in messages. This check helps
beginners, but it would slow down the simulator in every frame."""

NOBODYS_HOME = Path("/nonexistent")
"""The HOME of a server: a folder that only root can create. rclpy loads LTTng, which follows the instructions of any
program that listens on a socket in HOME. Therefore, a folder in /tmp would not be safe: another user could create it.
Each fork gets a HOME of its own."""


class ForkServer:
    """A process that forks itself for each request (grader.trial.forking).

    It exits when this process and all processes that this process has forked have exited.
    """

    def __init__(self, start: Callable[[int], subprocess.Popen[bytes] | None]) -> None:
        """Create a server. The method `start` starts its process, or else the first request does.

        The argument `start` is the function that starts the process. It gets the descriptor of the socket for requests,
        which the process inherits. It returns None if the process is a fork of another server.
        """
        self._start = start
        self._changing = Lock()
        self._requests: socket.socket | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._owner = 0
        atexit.register(self.close)

    def start(self) -> None:
        """Start the process, unless it is running. Processes that this process forks afterwards share the server."""
        with self._changing:
            self._running()

    def request(self, order: Mapping[str, Any], descriptors: Sequence[int]) -> Fork:
        """Request a fork. The server gets `order` and these file descriptors. Any thread may call this method.

        If the server ends before it has received the request, the fork counts as killed.
        """
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            passed = [*descriptors, theirs.fileno()]
            with self._changing, suppress(BrokenPipeError, ConnectionResetError):
                entering.pass_descriptors(self._running(), json.dumps(order).encode(), passed)
        return Fork(ours)

    def close(self) -> None:
        """Stop the server and its forks. A server that another process started keeps running."""
        with self._changing:
            if self._requests is not None:
                self._requests.close()
            if self._process is not None and self._owner == os.getpid():
                self._process.kill()
                self._process.wait()
            self._process = self._requests = None

    def _running(self) -> socket.socket:
        """Return the socket of the server. If the server is not running, start it."""
        if self._requests is None or _is_closed(self._requests):
            self._requests, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            with theirs:
                self._process, self._owner = self._start(theirs.fileno()), os.getpid()
        return self._requests


def _is_closed(requests: socket.socket) -> bool:
    """Return whether the other end of the socket is closed."""
    ends = select.poll()
    ends.register(requests, 0)
    return bool(ends.poll(0))


def _started(kind: Literal["conductor", "node"], ros: installation.Ros, descriptor: int) -> subprocess.Popen[bytes]:
    """Start grader.trial.fork_server."""
    env = installation.environment(ros, home=NOBODYS_HOME, domain=None)
    env |= CONDUCTORS if kind == "conductor" else {}
    module = ("-m", "grader.trial.fork_server", kind, str(descriptor))
    start = interpreter(*module, python=str(ros.python), env=env, searches=True)
    # Without a session of its own, a node could write into the input of the user's terminal. Without the loader, a node
    # could change the user's own interpreter through /proc/PID/exe (grader.common.loader).
    return subprocess.Popen(
        loaded(start.argv),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=start.env,
        pass_fds=[descriptor],
        start_new_session=True,
    )


def _forked(ros: installation.Ros, descriptor: int) -> None:
    """Fork the server for conductors from the server for nodes."""
    nodes(ros).request({"groups": [], "conductors": CONDUCTORS}, [descriptor]).close()


@cache
def conductors(ros: installation.Ros, *, share: bool) -> ForkServer:
    """Return the fork server for conductors that run with this ROS 2.

    With `share`, this server is a fork of the server for nodes, which saves one import of rclpy. Each node then knows
    the memory layout of its conductor, so do not share if the result counts for marks.
    """
    return ForkServer(partial(_forked, ros) if share else partial(_started, "conductor", ros))


@cache
def nodes(ros: installation.Ros) -> ForkServer:
    """Return the fork server for nodes that run with this ROS 2."""
    return ForkServer(partial(_started, "node", ros))
