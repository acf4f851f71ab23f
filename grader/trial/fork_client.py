"""Request conductors and nodes from the fork servers of this process (grader.trial.fork_server)."""

from __future__ import annotations

import atexit
import json
import socket
import subprocess
from functools import cache
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Any, Literal

from grader.common.interpreter import interpreter
from grader.common.loader import loaded
from grader.ros import installation
from grader.sandbox import entering
from grader.trial.fork import Fork

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

CONDUCTORS = {"ROS_PYTHON_CHECK_FIELDS": "0"}
"""Environment variables only for conductors. They disable the check of the values in messages. This check helps
beginners, but it would slow down the simulator in every frame."""


NOBODYS_HOME = Path("/nonexistent")
"""The HOME of a server: a folder that only root can create. rclpy loads LTTng, which follows the instructions of any
program that listens on a socket in HOME. Therefore, a folder in /tmp would not be safe: another user could create it.
Each fork gets a HOME of its own."""


class ForkServer:
    """A process that runs grader.trial.fork_server. It exits when this process exits."""

    def __init__(self, kind: Literal["conductor", "node"], ros: installation.Ros) -> None:
        self._kind, self._ros = kind, ros
        self._changing = Lock()
        self._requests: socket.socket | None = None
        self._process: subprocess.Popen[bytes] | None = None
        atexit.register(self.close)

    def request(self, order: Mapping[str, Any], descriptors: Sequence[int]) -> Fork:
        """Send a request with these file descriptors. Any thread may call this method."""
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            passed = [*descriptors, theirs.fileno()]
            with self._changing:
                if self._process is None or self._process.poll() is not None:
                    self._begin()
                assert self._requests is not None
                entering.pass_descriptors(self._requests, json.dumps(order).encode(), passed)
        return Fork(ours)

    def close(self) -> None:
        """Stop the server and its forks."""
        with self._changing:
            if self._process is not None and self._requests is not None:
                self._requests.close()
                self._process.kill()
                self._process.wait()
                self._process = self._requests = None

    def _begin(self) -> None:
        self._requests, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            module = ("-m", "grader.trial.fork_server", self._kind, str(theirs.fileno()))
            env = installation.environment(self._ros, home=NOBODYS_HOME, domain=None)
            env |= CONDUCTORS if self._kind == "conductor" else {}
            start = interpreter(*module, python=str(self._ros.python), env=env, searches=True)
            # Without a session of its own, a node could write into the input of the user's terminal. Without the
            # loader, a node could change an interpreter that belongs to the user, since no read-only mount hides this
            # interpreter.
            self._process = subprocess.Popen(
                loaded(start.argv),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env=start.env,
                pass_fds=[theirs.fileno()],
                start_new_session=True,
            )


@cache
def conductors(ros: installation.Ros) -> ForkServer:
    """Return the fork server for conductors that run with this ROS 2."""
    return ForkServer("conductor", ros)


@cache
def nodes(ros: installation.Ros) -> ForkServer:
    """Return the fork server for nodes that run with this ROS 2."""
    return ForkServer("node", ros)
