"""A worker: a process that grades one task after another.

The workers of a command are forks of one process, the worker server (`python -m grader.classroom.worker DESCRIPTOR`).
This process has imported everything that grading needs, and has started the fork servers of the trials
(grader.trial.fork_server), so that the workers share their memory, the fork servers and the turns for builds
(build_turns.py). Student code does not run in these processes, but in the sandbox cells that the workers start. If the
process that started the worker server exits, then the server, the workers and all their descendants exit too.
"""

from __future__ import annotations

import gc
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
import traceback
from contextlib import suppress
from functools import cache
from multiprocessing.connection import Connection
from threading import Thread
from typing import IO, TYPE_CHECKING, Literal

from grader.common.how_ended import how_ended
from grader.common.interpreter import interpreter
from grader.common.lazy import load_catkin_pkg, load_numpy
from grader.sandbox import entering
from grader.trial.fork_client import ForkServer
from grader.trial.forking import fork_supervised, next_request

if TYPE_CHECKING:
    from grader.classroom.task import Done, Pace, Task

Message = tuple[Literal["tells", "fails"], str] | tuple[Literal["now"], "Pace"] | tuple[Literal["done"], "Done"]
"""The messages that a worker sends. "fails" is for a MachineError that concerns all submissions."""

_LAST_WORDS = 1000


class Worker:
    """A worker process, as seen from the process that owns it.

    `connection` is readable when a message has arrived or the process has exited.
    """

    def __init__(self) -> None:
        self._errors: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - closed in `close`
        ours, theirs = socket.socketpair()
        with ours, theirs:
            self.process = _server().request({}, [theirs.fileno(), self._errors.fileno()])
            self.connection: Connection = Connection(ours.detach())

    def send(self, task: Task) -> None:
        """Send a task to the worker, which handles one task at a time.

        If the process has exited, the next `receive` returns None.
        """
        with suppress(BrokenPipeError, ConnectionResetError):
            self.connection.send(task)

    def receive(self) -> tuple[str, object] | None:
        """Return the next message, or None if the process has exited."""
        try:
            answer: tuple[str, object] = self.connection.recv()
        except (EOFError, OSError):
            return None
        return answer

    def last_words(self) -> str:
        """Return an explanation for the instructor: how the process exited, and the end of its output."""
        code = self.process.wait()
        self._errors.seek(0)
        answer = self._errors.read()[-_LAST_WORDS:].decode("utf-8", "replace").strip()
        how = f"it {how_ended(code)}"
        return f"{how}: {answer}" if answer else how

    def close(self) -> None:
        """Kill the process and everything that it started."""
        self.connection.close()
        self.process.signal(signal.SIGKILL)
        self.process.wait()
        self.process.close()
        self._errors.close()


@cache
def _server() -> ForkServer:
    """Return the worker server of this process."""
    return ForkServer(_started)


def _started(descriptor: int) -> subprocess.Popen[bytes]:
    """Start the worker server."""
    start = interpreter("-m", "grader.classroom.worker", str(descriptor))
    # With one memory pool instead of one for each thread, a worker needs 2 MB less (mallopt(3)).
    env = {**start.env, "MALLOC_ARENA_MAX": "1"}
    # The server gets its own session, so that Ctrl-C reaches only the owner.
    return subprocess.Popen(
        start.argv,
        env=env,
        pass_fds=[descriptor],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )


def main(descriptor: int) -> None:
    """Import everything, and fork a worker for each request until the owner exits."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    gc.disable()  # imports leave hardly any garbage
    problem = ""
    try:
        _import_all()
        _start_fork_servers()
    except Exception:  # a module is missing, for example
        problem = traceback.format_exc()
    _, (connection, errors, result) = next_request(socket.socket(fileno=descriptor))
    fork_supervised(result, [connection, errors])
    entering.end_with_parent()
    os.dup2(errors, 1)
    os.dup2(errors, 2)
    os.close(errors)
    if problem:
        os.write(2, problem.encode())
        os._exit(1)
    _grade_tasks(connection)
    os._exit(0)


def _grade_tasks(descriptor: int) -> None:
    """Grade tasks until the owner exits."""
    os.set_inheritable(descriptor, False)  # noqa: FBT003
    connection = Connection(descriptor)
    Thread(target=_end_with_owner, args=(descriptor,), daemon=True).start()
    from grader.classroom import task as tasks
    from grader.errors import MachineError

    while True:
        try:
            task = connection.recv()
        except (EOFError, ConnectionResetError):
            return
        try:
            done = tasks.perform(
                task, lambda text: connection.send(("tells", text)), lambda pace: connection.send(("now", pace))
            )
        except MachineError as error:
            connection.send(("fails", str(error)))
        else:
            connection.send(("done", done))


def _import_all() -> None:
    """Import in advance the modules that grading needs, so that the first task does not have to wait for the import."""
    import grader.classroom.task
    import grader.report.html  # noqa: F401
    from grader.classroom.build_turns import lock_file

    load_catkin_pkg()
    load_numpy()
    with suppress(OSError):  # then nobody waits for a turn
        lock_file()


def _start_fork_servers() -> None:
    """Start the fork servers that all workers share. If there is no sandbox or no ROS 2, start none."""
    from grader.errors import MachineError
    from grader.ros import installation, underlay
    from grader.sandbox import bubblewrap
    from grader.trial import fork_client

    with suppress(MachineError):
        if bubblewrap.usable():
            ros = underlay.with_turtlesim(installation.find_ros())
            fork_client.conductors(ros, share=False).start()
            fork_client.nodes(ros).start()


def _end_with_owner(descriptor: int) -> None:
    """Exit as soon as the owner has exited. The sandbox rooms of this worker, and the cells in them, then end, too."""
    poll = select.poll()
    poll.register(descriptor, 0)  # POLLHUP is always reported
    while True:
        for _, event in poll.poll():
            if event & (select.POLLHUP | select.POLLERR | select.POLLNVAL):
                os._exit(0)


if __name__ == "__main__":
    main(int(sys.argv[1]))
