"""A fork can be closed by any thread, and is then no longer watched."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import threading

from grader.common.linux_calls import pidfd_open
from grader.tests.waiting import HANG_S
from grader.trial.fork import STARTED, Fork


def a_fork() -> tuple[Fork, socket.socket]:
    """Return a fork that has not started, and the socket of its fork server."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    return Fork(ours), theirs


def test_closing_ends_the_wait_of_another_thread() -> None:
    fork, server = a_fork()
    found: list[int | None] = []
    waiting = threading.Thread(target=lambda: found.append(fork.await_started()))
    waiting.start()
    fork.close()
    waiting.join(HANG_S)
    assert found == [None]
    assert server.recv(1) == b""
    server.close()


def test_a_closed_fork_has_no_process_and_gets_no_signal() -> None:
    fork, server = a_fork()
    with subprocess.Popen(["sleep", "600"]) as process:
        descriptor = pidfd_open(process.pid)
        socket.send_fds(server, [STARTED], [descriptor])
        os.close(descriptor)
        assert fork.await_started() == process.pid
        fork.close()
        fork.close()
        assert fork.await_started() is None
        fork.signal(signal.SIGKILL)
        assert process.poll() is None
        process.kill()
    server.close()
