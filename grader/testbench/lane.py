"""A lane: a sandbox cell in which tests run on one node after another, and the code that controls the current node."""

from __future__ import annotations

import json
import os
import selectors
import signal
import struct
import subprocess
import time
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.common.interpreter import interpreter
from grader.errors import MachineError
from grader.ros import installation
from grader.sandbox import bubblewrap
from grader.sandbox.control_group import control_group
from grader.sandbox.limits import NODE_LIMITS, limited
from grader.sandbox.system_calls import call_filter
from grader.sandbox.usage import Guard
from grader.sandbox.user import cell_user
from grader.testbench.brain import Brain
from grader.testbench.result import Ended

if TYPE_CHECKING:
    from grader.exercise.node_under_test import Behaviour
    from grader.ros.installation import Ros

SESSION = Path(__file__).absolute().with_name("session.py")
MOST_QUESTIONS = 100_000
"""The maximum number of requests that are answered in one run. A normal test makes only a few hundred requests."""
MOST_REPORT = 64 * 1024
EXTRA_S = 30.0
"""The time that a run may take in addition to its tests, for forking and cleaning up (s)."""
START_S = 120.0
"""The maximum time for the imports, on a crowded machine (s)."""
_QUESTION = struct.Struct("<cHqdd")
READY = b"ready\n"
"""The session writes this line when it is ready to run tests (see session.py)."""
_HEADER = struct.Struct("<i?dI")
_LENGTH = struct.Struct("<H")
_DISKS = ("/ws", "/tmp", "/dev/shm")


@dataclass(frozen=True)
class Package:
    """The package with the tests: its name, its files as a tar stream, and the name of its node."""

    name: str
    tree: bytes
    node: str


class Lane:
    """A sandbox cell and the session that runs in this cell, as a context manager.

    On entry, the session starts its imports. Without a cell, the session uses `folder`, which no other lane uses, and
    its nodes discover no other nodes on the machine.
    """

    def __init__(self, ros: Ros, package: Package, duration_s: float, folder: Path | None = None) -> None:
        self._ros = ros
        self._package = package
        self._duration_s = duration_s
        self._in_cell = folder is None
        self._workspace = folder or bubblewrap.WORKSPACE
        self._home = bubblewrap.HOME if folder is None else folder / "home"
        self._stack = ExitStack()
        self._out_of = ""
        self._started = False
        self._ready = False

    def __enter__(self) -> Lane:  # noqa: PYI034 - typing.Self is Python 3.11's
        try:
            self._start()
        except BaseException:
            self._stack.close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def _start(self) -> None:
        self._asks, child_asks = os.pipe()
        child_answers, self._answers = os.pipe()
        os.set_blocking(self._answers, False)
        for kept in (self._asks, self._answers):
            self._stack.callback(os.close, kept)
        env = installation.environment(self._ros, home=self._home)
        env |= {"GRADER_TESTBENCH": f"{child_asks} {child_answers}", "PYTHONDONTWRITEBYTECODE": "1"}
        env["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
        if not self._in_cell:
            env["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "OFF"
        start = interpreter(str(SESSION), python=str(self._ros.python), env=env, searches=True)
        with ExitStack() as only_now:
            for childs in (child_asks, child_answers):
                only_now.callback(os.close, childs)
            filter_fd = only_now.enter_context(call_filter())
            passed = [child_asks, child_answers, *([] if filter_fd is None or not self._in_cell else [filter_fd])]
            group = self._stack.enter_context(control_group(NODE_LIMITS))
            if self._in_cell:
                view = bubblewrap.ros_view(self._ros, installation.FASTDDS_PROFILE, SESSION)
                user = self._stack.enter_context(cell_user())
                argv = group.joined(
                    bubblewrap.lone_cell(
                        start.argv, view, env=start.env, limits=NODE_LIMITS, user=user, filter_fd=filter_fd
                    )
                )
            else:
                argv = limited(start.argv, NODE_LIMITS)
            self._process = subprocess.Popen(
                argv,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                env=start.env,
                pass_fds=passed,
                start_new_session=True,
            )
        self._stack.callback(self._end)
        order = {
            "size": len(self._package.tree),
            "package": self._package.name,
            "workspace": str(self._workspace),
            "home": str(self._home),
            "disks": _DISKS if self._in_cell else [str(self._workspace)],
            "duration_s": self._duration_s,
            "answers": child_answers,
            "in_cell": self._in_cell,
            "env": {},
        }
        self._guard = Guard(self._process.pid, NODE_LIMITS, self._over)
        self._stack.callback(self._guard.close)
        self._send(json.dumps(order).encode() + b"\n" + self._package.tree)

    def run(self, node: str, behaviour: Behaviour) -> Ended:
        """Run the tests on a node (the id of a broken node, or "" for the correct node), and return the result.

        Raises:
            MachineError: pytest or rclpy could not be imported.
        """
        brain, begun = Brain(behaviour, self._package.node), time.monotonic()
        until = begun + self._duration_s + (EXTRA_S if self._started else START_S)
        self._send(b".")
        answer = self._converse(brain, until)
        if answer is not None:
            self._started = True
            code, over, seconds, _ = _HEADER.unpack(answer[: _HEADER.size])
            return Ended(node, code, over, seconds, answer[_HEADER.size :])
        if not self._ready:
            raise MachineError("pytest and rclpy could not be started: `grader doctor` says what is missing.")  # noqa: EM101
        return Ended(node, None, time.monotonic() >= until, time.monotonic() - begun)

    def _converse(self, brain: Brain, until: float) -> bytes | None:
        """Answer requests about the node until the session reports the end of the run.

        Return None if there is no such report.
        """
        assert self._process.stdout is not None
        reports = self._process.stdout.fileno()
        asked, rest, received = 0, b"", b""
        with selectors.DefaultSelector() as selector:
            selector.register(self._asks, selectors.EVENT_READ)
            selector.register(reports, selectors.EVENT_READ)
            while (left_s := until - time.monotonic()) > 0:
                ready = [key.fd for key, _ in selector.select(left_s)]
                if self._asks in ready:
                    data = os.read(self._asks, 4096)
                    rest += data
                    while len(rest) >= _QUESTION.size and asked < MOST_QUESTIONS:
                        self._answer(brain, rest[: _QUESTION.size])
                        rest, asked = rest[_QUESTION.size :], asked + 1
                    if not data or asked >= MOST_QUESTIONS:
                        selector.unregister(self._asks)
                if reports in ready:
                    data = os.read(reports, 65536)
                    received += data
                    if not self._ready and received.startswith(READY):
                        self._ready, received = True, received[len(READY) :]
                    if len(received) >= _HEADER.size:
                        whole = _HEADER.size + min(_HEADER.unpack(received[: _HEADER.size])[3], MOST_REPORT)
                        if len(received) >= whole:
                            self._discard_questions()
                            return received[:whole]
                    if not data:
                        return None
        self.kill()
        return None

    def _answer(self, brain: Brain, question: bytes) -> None:
        event, number, now_ns, x, y = _QUESTION.unpack(question)
        answer: Any = None
        if event == b"n":
            answer = brain.create()
        elif event == b"p":
            brain.pose(number, now_ns, x, y)
        elif event == b"t":
            answer = brain.tick(number, now_ns)
        data = json.dumps(answer).encode()
        with suppress(OSError):  # a run that does not read its answers gets no further answers
            os.write(self._answers, _LENGTH.pack(len(data)) + data)

    def _discard_questions(self) -> None:
        os.set_blocking(self._asks, False)
        with suppress(BlockingIOError):
            while os.read(self._asks, 65536):
                pass
        os.set_blocking(self._asks, True)

    def _send(self, data: bytes) -> None:
        assert self._process.stdin is not None
        with suppress(BrokenPipeError):  # the process has exited, and `run` will notice
            self._process.stdin.write(data)
            self._process.stdin.flush()

    def _over(self, what: str) -> None:
        self._out_of = what
        self.kill()

    def kill(self) -> None:
        """Kill all processes of the cell."""
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)

    def _end(self) -> None:
        self.kill()
        for pipe in (self._process.stdin, self._process.stdout):
            assert pipe is not None
            with suppress(BrokenPipeError):
                pipe.close()
        self._process.wait()
