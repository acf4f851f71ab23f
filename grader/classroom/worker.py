"""A worker process that grades one task after another, so that Python modules are imported only once.

`python -m grader.classroom.worker DESCRIPTOR`. Student code does not run in the worker process, but in the sandbox
cells that the worker starts. If the process that started the worker exits, then the worker and all its descendants exit
too.
"""

from __future__ import annotations

import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
from contextlib import suppress
from multiprocessing.connection import Connection
from threading import Thread
from typing import IO, TYPE_CHECKING, Literal

from grader.common.how_ended import how_ended
from grader.common.interpreter import interpreter
from grader.common.lazy import load_catkin_pkg, load_numpy

if TYPE_CHECKING:
    from grader.classroom.task import Done, Pace, Task

Message = tuple[Literal["tells"], str] | tuple[Literal["now"], "Pace"] | tuple[Literal["done"], "Done"]
"""The messages that a worker sends. A worker also sends ("fails", text) for a MachineError that no submission
caused."""

_LAST_WORDS = 1000


class Worker:
    """A worker process, as seen from the process that owns it.

    `connection` is readable when a message has arrived or the process has exited.
    """

    def __init__(self) -> None:
        ours, theirs = socket.socketpair()
        self._errors: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - closed in `close`
        with theirs:
            # The worker gets its own session, so that Ctrl-C reaches only the owner.
            start = interpreter("-m", "grader.classroom.worker", str(theirs.fileno()))
            self.process = subprocess.Popen(
                start.argv,
                env=start.env,
                pass_fds=(theirs.fileno(),),
                stdin=subprocess.DEVNULL,
                stdout=self._errors,
                stderr=self._errors,
                start_new_session=True,
            )
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
        self.process.kill()
        self.process.wait()
        self._errors.close()


def main(descriptor: int) -> None:
    """Grade tasks until the owner exits."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.set_inheritable(descriptor, False)  # noqa: FBT003
    connection = Connection(descriptor)
    Thread(target=_end_with_owner, args=(descriptor,), daemon=True).start()
    from grader.classroom import task as tasks
    from grader.errors import MachineError

    _import_all()
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
    import grader.report.html  # noqa: F401

    load_catkin_pkg()
    load_numpy()


def _end_with_owner(descriptor: int) -> None:
    """Exit as soon as the owner has exited. Every sandbox cell exits together with its parent process."""
    poll = select.poll()
    poll.register(descriptor, 0)  # POLLHUP is always reported
    while True:
        for _, event in poll.poll():
            if event & (select.POLLHUP | select.POLLERR | select.POLLNVAL):
                os._exit(0)


if __name__ == "__main__":
    main(int(sys.argv[1]))
