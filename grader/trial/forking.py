"""Fork a process for each request on a socket, and report how the forked process ends.

A fork server imports everything that its forks need, and then calls `next_request`. A process that requests a fork
(grader.trial.fork_client) gets a socket for the result (grader.trial.fork).
"""

from __future__ import annotations

import gc
import os
import select
import signal
import socket
from contextlib import suppress
from typing import TYPE_CHECKING

from grader.common.linux_calls import pidfd_open, pidfd_send_signal
from grader.sandbox import entering
from grader.trial.fork import STARTED, STATUS

if TYPE_CHECKING:
    from collections.abc import Sequence

MOST_REQUEST = 64 * 1024
"""The maximum size of a request (bytes)."""
MOST_PASSED = 6
"""The maximum number of file descriptors that are sent with a request."""


def next_request(requests: socket.socket) -> tuple[bytes, list[int]]:
    """Wait for requests, and fork this process for each request.

    Return only in the child process, with the request and the file descriptors that were sent with it. The child
    process ends when this process ends. When the socket is closed at the other end, this process ends.
    """
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for the forks
    gc.freeze()
    gc.enable()
    while True:
        request, passed, *_ = socket.recv_fds(requests, MOST_REQUEST, MOST_PASSED)
        if not request:
            os._exit(0)
        if _forked():
            break
        for descriptor in passed:
            os.close(descriptor)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    requests.close()
    entering.end_with_parent()
    return request, passed


def _forked() -> bool:
    """Fork this process, and return whether this is the child process.

    If no child process can be created, return False. The socket for the result is then closed, so that the process that
    requested the fork notices the failure, and other forks continue.
    """
    try:
        return os.fork() == 0
    except OSError:  # too many processes
        return False


def fork_supervised(result: int, childs: Sequence[int]) -> None:
    """Fork, and return only in the child process. The parent process reports how the child process ends.

    The parent process closes the descriptors `childs`, and kills the child process if the other end of the socket
    `result` is closed.
    """
    results = socket.socket(fileno=result)
    child = os.fork()
    if child == 0:
        results.close()
        os.setsid()  # otherwise, signals to its process group would reach the server and other forks
        return
    entering.end_with_parent()  # entering a cell may have cancelled the earlier call
    for descriptor in childs:
        os.close(descriptor)
    process = pidfd_open(child)
    try:
        entering.pass_descriptors(results, STARTED, [process])
        ends = select.poll()
        ends.register(process, select.POLLIN)
        ends.register(results, 0)  # only the end of the connection
        if all(descriptor != process for descriptor, _ in ends.poll()):
            pidfd_send_signal(process, signal.SIGKILL)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        results.send(STATUS.pack(code))
    except OSError:  # nobody waits for the result
        with suppress(ProcessLookupError):
            pidfd_send_signal(process, signal.SIGKILL)
    os._exit(0)
