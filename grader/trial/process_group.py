"""The process group of a trial, which can be suspended while the trial waits for its node."""

from __future__ import annotations

import os
import signal
from contextlib import suppress
from threading import Lock


class ProcessGroup:
    """The process group that a process leads. Any thread may call the methods."""

    def __init__(self, leader: int) -> None:
        self.leader = leader
        self._changing = Lock()
        self._may_be_suspended = True

    def suspend(self) -> None:
        """Suspend the processes until `resume` or `kill`. After `resume` or `kill`, do nothing."""
        with self._changing:
            if self._may_be_suspended:
                self._signal(signal.SIGSTOP)

    def resume(self) -> None:
        """Let the processes continue, and do not suspend them again."""
        with self._changing:
            if self._may_be_suspended:
                self._may_be_suspended = False
                self._signal(signal.SIGCONT)

    def kill(self) -> None:
        """Kill the processes.

        The caller must not have waited for the leader process yet, because its id could otherwise belong to another
        process.
        """
        with self._changing:
            self._may_be_suspended = False
            self._signal(signal.SIGKILL)

    def _signal(self, number: int) -> None:
        with suppress(ProcessLookupError):
            os.killpg(self.leader, number)
