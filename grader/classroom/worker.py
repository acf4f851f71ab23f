"""A worker: a process of ours that grades one task after another, so that Python's imports are paid once.

`python -m grader.classroom.worker DESCRIPTOR`. Nothing of a student's runs in it: that is in the cells it starts. It
ends, and all that it started with it, when whoever started it has gone.
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

from grader.common.interpreter import interpreter

if TYPE_CHECKING:
    from grader.classroom.task import Done, Pace, Task

Message = tuple[Literal["tells"], str] | tuple[Literal["now"], "Pace"] | tuple[Literal["done"], "Done"]
"""What a worker says; besides ("fails", text): a MachineError that is no submission's."""

_LAST_WORDS = 1000


class Worker:
    """A worker process, as its owner sees it; `connection` becomes readable when it says something, or has ended."""

    def __init__(self) -> None:
        ours, theirs = socket.socketpair()
        self._errors: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - closed in `close`
        with theirs:
            # A session of its own: Ctrl-C is its owner's to handle.
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
        """Give it a task; one at a time. That it has ended is seen when reading."""
        with suppress(BrokenPipeError, ConnectionResetError):
            self.connection.send(task)

    def receive(self) -> tuple[str, object] | None:
        """The next that it says; None when it has ended."""
        try:
            said: tuple[str, object] = self.connection.recv()
        except (EOFError, OSError):
            return None
        return said

    def last_words(self) -> str:
        """How it ended, and what it wrote last: for the instructor."""
        code = self.process.wait()
        self._errors.seek(0)
        said = self._errors.read()[-_LAST_WORDS:].decode("utf-8", "replace").strip()
        how = f"it was killed ({signal.Signals(-code).name})" if code < 0 else f"it ended with exit code {code}"
        return f"{how}: {said}" if said else how

    def close(self) -> None:
        """End it and all that it started."""
        self.connection.close()
        self.process.kill()
        self.process.wait()
        self._errors.close()


def main(descriptor: int) -> None:
    """Grade until there is nobody to grade for."""
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
    """What grading imports on first use, now: while the others grade already, and before the clock of a task runs."""


def _end_with_owner(descriptor: int) -> None:
    """Cells and rooms are made to die with their parent: so end at once, in the midst of whatever it is."""
    poll = select.poll()
    poll.register(descriptor, 0)  # hangups are always told
    while True:
        for _, event in poll.poll():
            if event & (select.POLLHUP | select.POLLERR | select.POLLNVAL):
                os._exit(0)


if __name__ == "__main__":
    main(int(sys.argv[1]))
