"""A lane: a sandbox room with a session, which runs the tests on one node after another, each time in a new cell."""

from __future__ import annotations

import base64
import json
import os
import selectors
import signal
import socket
import subprocess
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common import linux_calls
from grader.common.interpreter import interpreter
from grader.errors import MachineError
from grader.ros import installation
from grader.sandbox import bubblewrap, entering, holder
from grader.sandbox.control_group import control_group
from grader.sandbox.descendants import kill_descendants
from grader.sandbox.limits import NODE_LIMITS, limited, resource_limits
from grader.sandbox.system_calls import program
from grader.sandbox.usage import Guard
from grader.sandbox.user import cell_user
from grader.testbench.brain import Brain
from grader.testbench.conversation import Conversation
from grader.trial.own_domain import own_domain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.exercise.node_under_test import Behaviour
    from grader.ros.installation import Ros
    from grader.testbench.result import Ended

SESSION = Path(__file__).absolute().with_name("session.py")
START_S = 120.0
"""The maximum time for the imports (s), which is long enough for a busy machine."""
READY = b"ready\n"
"""The session writes this line when it is ready to run tests (see session.py)."""
FILTER, ASKS, ANSWERS = 100, 3, 4
"""The descriptors of the call filter, of the requests and of the responses, as in session.py."""
OURS = (SESSION, Path(linux_calls.__file__), Path(entering.__file__), Path(holder.__file__))
"""The files of the grader that a session needs."""


@dataclass(frozen=True)
class Package:
    """The package with the tests: its name, its files as a tar stream, and the name of its node."""

    name: str
    tree: bytes
    node: str
    alone: bool
    """Whether the nodes of a run need no discovery. If so, discovery is switched off: it would only find the nodes of
    earlier tests, and takes a fifth of the time of a run."""


class Lane:
    """A sandbox room and the session that runs in this room, as a context manager.

    When the context is entered, the session begins to import its modules. Without cells, the session uses `folder`
    and a ROS domain that no other lane uses.
    """

    def __init__(self, ros: Ros, package: Package, duration_s: float, folder: Path | None = None) -> None:
        self._ros = ros
        self._package = package
        self._duration_s = duration_s
        self._in_cell = folder is None
        self._workspace = folder or bubblewrap.WORKSPACE
        self._home = bubblewrap.HOME if folder is None else folder / "home"
        self._stack = ExitStack()
        self._killed = False
        self._ready = False
        self._has_begun = False

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
        domain = None if self._in_cell else own_domain(self._stack)
        env = installation.environment(self._ros, home=self._home, domain=domain)
        env |= {"GRADER_TESTBENCH": f"{ASKS} {ANSWERS}", "PYTHONDONTWRITEBYTECODE": "1"}
        env["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
        if self._package.alone:
            env["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "OFF"
        start = interpreter(str(SESSION), python=str(self._ros.python), env=env, searches=True)
        view = bubblewrap.ros_view(self._ros, installation.FASTDDS_PROFILE, *OURS)
        ours, theirs = socket.socketpair()
        self._requests = self._stack.enter_context(ours)
        with theirs:
            group = self._stack.enter_context(control_group(NODE_LIMITS))
            if self._in_cell:
                user = self._stack.enter_context(cell_user())
                argv = group.joined(bubblewrap.room(start.argv, view, env=start.env, user=user))
            else:
                argv = limited(start.argv, NODE_LIMITS)
            self._process = subprocess.Popen(
                argv,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                env=start.env,
                pass_fds=[theirs.fileno()],
                start_new_session=True,
            )
            requests = theirs.fileno()
        self._stack.callback(self._end)
        self._guard = Guard([self._process.pid], NODE_LIMITS, lambda _: self.kill())
        self._stack.callback(self._guard.close)
        filter_ = program()
        order = {
            "size": len(self._package.tree),
            "package": self._package.name,
            "workspace": str(self._workspace),
            "home": str(self._home),
            "requests": requests,
            "cell": _cell(self._ros, FILTER if filter_ else None) if self._in_cell else None,
            "filter": base64.b64encode(filter_).decode() if filter_ else None,
            "limits": list(resource_limits(NODE_LIMITS, in_cell=True).items()),
        }
        assert self._process.stdin is not None
        with suppress(BrokenPipeError):  # the process has exited, and `run` will notice
            self._process.stdin.write(json.dumps(order).encode() + b"\n" + self._package.tree)
            self._process.stdin.flush()

    def run(self, node: str, behaviour: Behaviour, test_s: float) -> Ended:
        """Run the tests on a node, and return the result.

        `node` is the id of a broken node, or "" for the correct node. Each test may take `test_s` seconds.

        Raises:
            MachineError: the sandbox, pytest or rclpy does not work on this machine.
        """
        self._wait_until_ready()
        brain = Brain(behaviour, self._package.node)
        with Conversation(node, brain, test_s, self._duration_s, self._guard.worked_s) as conversation:
            with suppress(OSError):  # the session has exited, and the conversation ends at once
                entering.pass_descriptors(self._requests, b".", conversation.childs)
            conversation.passed()
            ended = conversation.result()
            if not (conversation.has_begun or self._has_begun or self._killed):
                raise MachineError("No cell could be created for the tests. Check this machine with `grader doctor`.")  # noqa: EM101
            self._has_begun = True
        return ended

    def _wait_until_ready(self) -> None:
        if self._ready:
            return
        assert self._process.stdout is not None
        with selectors.DefaultSelector() as selector:
            selector.register(self._process.stdout, selectors.EVENT_READ)
            self._ready = bool(selector.select(START_S)) and self._process.stdout.read(len(READY)) == READY
        if not self._ready and not self._killed:
            message = (
                "The tests could not be started: the sandbox, pytest or rclpy does not work, or the machine is too "
                "busy. Check this machine with `grader doctor`."
            )
            raise MachineError(message)

    def kill(self) -> None:
        """Kill all processes of the room and its cells. Without a sandbox, kill the session and all its descendants."""
        self._killed = True
        if not self._in_cell and self._process.poll() is None:
            kill_descendants(self._process.pid)
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)

    def _end(self) -> None:
        self.kill()
        for pipe in (self._process.stdin, self._process.stdout):
            assert pipe is not None
            with suppress(BrokenPipeError):
                pipe.close()
        self._process.wait()


def _cell(ros: Ros, filter_fd: int | None) -> Sequence[str]:
    """Return the command that opens a cell for forks. The session replaces the descriptor of --info-fd."""
    view = bubblewrap.ros_view(ros, installation.FASTDDS_PROFILE)
    env = {"PATH": "/usr/bin:/bin"}
    return bubblewrap.cell(
        *(entering.HOLDER, view), env=env, limits=NODE_LIMITS, info_fd=-1, filter_fd=filter_fd, first=True
    )
