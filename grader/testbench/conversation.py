"""The conversation with one run of the tests: respond to the requests of its nodes, and receive its result."""

from __future__ import annotations

import json
import os
import selectors
import signal
import socket
import struct
import time
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.common.linux_calls import pidfd_send_signal
from grader.testbench.patience import Patience
from grader.testbench.result import Ended

if TYPE_CHECKING:
    from grader.testbench.brain import Brain
    from grader.testbench.patience import WorkedS

MOST_QUESTIONS = 100_000
"""The maximum number of requests to which the grader responds in one run.

A normal test makes only a few hundred requests.
"""
MOST_REPORT = 64 * 1024
LATEST = 4.0
"""Even on a busy machine, a run is stopped after END_S plus this multiple of its time limit."""
END_S = 30.0
"""The time (s) that is allowed for creating a cell, and the same time for ending it."""
LOOK_S = 0.1
_QUESTION = struct.Struct("<cHqdd")
_HEADER = struct.Struct("<idI")
_LENGTH = struct.Struct("<H")


class Conversation:
    """The pipes between the grader and one run of the tests, as a context manager.

    `childs` contains the ends for the session. As soon as they have been sent to the session, call `passed` to close
    them in this process.
    """

    def __init__(self, node: str, brain: Brain, test_s: float, run_s: float, worked_s: WorkedS) -> None:
        self._node, self._brain = node, brain
        self._test_s, self._run_s, self._worked_s = test_s, run_s, worked_s
        self._patience: Patience | None = None
        self._process: int | None = None
        self._asked, self._rest, self._received = 0, b"", b""

    def __enter__(self) -> Conversation:  # noqa: PYI034 - typing.Self is Python 3.11's
        with ExitStack() as stack:
            self._asks, child_asks = os.pipe()
            stack.callback(os.close, self._asks)
            child_answers, self._answers = os.pipe()
            stack.callback(os.close, self._answers)
            os.set_blocking(self._answers, False)
            ours, theirs = socket.socketpair()
            self._result = stack.enter_context(ours)
            self._childs = stack.enter_context(ExitStack())
            for descriptor in (child_asks, child_answers):
                self._childs.callback(os.close, descriptor)
            self._childs.callback(theirs.close)
            self.childs = (child_asks, child_answers, theirs.fileno())
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()
        if self._patience is not None:
            self._patience.close()
        if self._process is not None:
            os.close(self._process)

    @property
    def has_begun(self) -> bool:
        """Whether the tests have started in their cell."""
        return self._process is not None

    def passed(self) -> None:
        """Close the ends that have been sent to the session."""
        self._childs.close()

    def result(self) -> Ended:
        """Respond to the requests of the run until it ends or exceeds its time limit, and return its result."""
        begun, over = time.monotonic(), False
        until = begun + LATEST * self._run_s + END_S
        with selectors.DefaultSelector() as selector:
            selector.register(self._asks, selectors.EVENT_READ)
            selector.register(self._result, selectors.EVENT_READ)
            while True:
                ready = [key.fd for key, _ in selector.select(LOOK_S)]
                if self._asks in ready and not self._answer_all():
                    selector.unregister(self._asks)
                if self._result.fileno() in ready and not self._receive():
                    break
                now = time.monotonic()
                if not over and self._patience is not None and (now >= until or self._patience.is_over()):
                    over, until = True, now + END_S
                    self._kill()
                elif now >= until:
                    break
        code, seconds, size = None, time.monotonic() - begun, 0
        if len(self._received) >= _HEADER.size:
            code, seconds, size = _HEADER.unpack(self._received[: _HEADER.size])
        report = self._received[_HEADER.size :][: min(size, MOST_REPORT)]
        stuck = self._patience is not None and self._patience.stuck
        return Ended(self._node, None if over else code, over, seconds, report, stuck, self._brain.events())

    def _receive(self) -> bool:
        """Receive a part of the result. Return False at its end."""
        data, passed, *_ = socket.recv_fds(self._result, 65536, 1)
        if passed and self._process is None:
            self._process = passed[0]
            self._patience = Patience(_pid_of(self._process), self._test_s, self._run_s, self._worked_s)
            data = data[1:]  # the message STARTED of session.py
        self._received += data
        return bool(data or passed)

    def _answer_all(self) -> bool:
        """Respond to the requests that have arrived. Return False if there will be no further responses."""
        data = os.read(self._asks, 4096)
        self._rest += data
        while len(self._rest) >= _QUESTION.size and self._asked < MOST_QUESTIONS:
            self._answer(self._rest[: _QUESTION.size])
            self._rest, self._asked = self._rest[_QUESTION.size :], self._asked + 1
        if self._patience is not None:
            self._patience.answered()
        return bool(data) and self._asked < MOST_QUESTIONS

    def _answer(self, question: bytes) -> None:
        event, number, now_ns, x, y = _QUESTION.unpack(question)
        if event == b"d":
            if self._patience is not None:
                self._patience.test_ended()
            return
        answer: Any = None
        if event == b"n":
            answer = self._brain.create()
        elif event == b"p":
            self._brain.pose(number, now_ns, x, y)
        elif event == b"t":
            answer = self._brain.tick(number, now_ns)
        data = json.dumps(answer).encode()
        with suppress(OSError):  # a run that does not read its responses gets no further ones
            os.write(self._answers, _LENGTH.pack(len(data)) + data)

    def _kill(self) -> None:
        assert self._process is not None
        with suppress(ProcessLookupError):
            pidfd_send_signal(self._process, signal.SIGKILL)


def _pid_of(process: int) -> int:
    """Return the pid, in this process's pid namespace, of the process to which a pidfd refers."""
    lines = Path(f"/proc/self/fdinfo/{process}").read_text("ascii").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("Pid:"))
