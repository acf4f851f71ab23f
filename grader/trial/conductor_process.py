"""Start the conductor of a trial: as a fork in a new room of the sandbox, or as a process without a sandbox."""

from __future__ import annotations

import base64
import os
import resource
import signal
import socket
import subprocess
from abc import ABC, abstractmethod
from contextlib import ExitStack, suppress
from pathlib import Path
from threading import Lock
from typing import IO, Any

import grader
from grader.common.interpreter import interpreter
from grader.ros import installation
from grader.sandbox import bubblewrap, system_calls
from grader.sandbox.control_group import ControlGroup, control_group
from grader.sandbox.descendants import kill_descendants
from grader.sandbox.entering import HOLDER
from grader.sandbox.holder import Holder
from grader.sandbox.limits import MIB, NODE_LIMITS, allowed, resource_limits
from grader.sandbox.user import cell_user
from grader.trial import fork_client

MOST_MEMORY = 3 * 1024 * MIB
"""The maximum address space of a conductor in a room (bytes). The conductor itself needs 1 GiB. Messages from the node
can fill the rest."""
MOST_ERRORS = 64 * MIB
"""The maximum size of a file that a conductor in a room writes (bytes). The limit is needed because the standard error
of the conductor is a file outside the room. The messages of a node can make the libraries of ROS 2 print errors."""

_PLAIN = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin"}


class ConductorProcess(ABC):
    """The process of a conductor, its pipes, and the processes of its nodes. Any thread may call the methods."""

    stdin: IO[bytes]
    stdout: IO[bytes]

    def __init__(self) -> None:
        self._changing = Lock()
        self._may_be_suspended = True

    def suspend(self) -> None:
        """Suspend the conductor until `resume` or `kill` is called. After that, this method does nothing."""
        with self._changing:
            if self._may_be_suspended:
                self._signal(signal.SIGSTOP)

    def resume(self) -> None:
        """Let the conductor continue. After that, it cannot be suspended again."""
        with self._changing:
            if self._may_be_suspended:
                self._may_be_suspended = False
                self._signal(signal.SIGCONT)

    def kill(self) -> None:
        """Kill the conductor and the nodes."""
        with self._changing:
            self._may_be_suspended = False
            self._kill()

    def out_of_memory(self) -> bool:
        """Return whether the kernel killed a process because the trial used too much memory.

        Without a sandbox, return False.
        """
        return False

    @abstractmethod
    def pids(self) -> tuple[int, ...]:
        """Return process ids: these processes and their descendants are all processes of the trial."""

    @abstractmethod
    def wait(self, timeout: float) -> int:
        """Wait until the conductor has exited, and return its exit code.

        Raises:
            subprocess.TimeoutExpired: the process did not exit within `timeout` (s).
        """

    @abstractmethod
    def close(self) -> None:
        """Kill the conductor and the nodes, and wait until they have exited."""

    @abstractmethod
    def _signal(self, number: int) -> None: ...

    @abstractmethod
    def _kill(self) -> None: ...


class PlainConductor(ConductorProcess):
    """A conductor that runs without a sandbox and leads its own process group."""

    def __init__(self, ros: installation.Ros, home: Path, domain: int | None, errors: IO[bytes]) -> None:
        """Start the conductor, with this folder as HOME and in this ROS domain."""
        super().__init__()
        env = {**installation.environment(ros, home=home, domain=domain), **fork_client.CONDUCTORS}
        start = interpreter("-m", "grader.trial.conductor", python=str(ros.python), env=env, searches=True)
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(
            start.argv, stdin=pipe, stdout=pipe, stderr=errors, env=start.env, start_new_session=True
        )
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self.stdin, self.stdout = self._process.stdin, self._process.stdout

    def pids(self) -> tuple[int, ...]:
        """Return the id of the conductor."""
        return (self._process.pid,)

    def wait(self, timeout: float) -> int:
        """Wait until the conductor has exited, and return its exit code."""
        return self._process.wait(timeout)

    def close(self) -> None:
        """Kill the conductor and all its descendants, and wait for the conductor."""
        self.kill()
        _close(self.stdin, self.stdout)
        self._process.wait()

    def _signal(self, number: int) -> None:
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, number)

    def _kill(self) -> None:
        # Each node has its own process group, and may have started processes in other sessions.
        if self._process.poll() is None:
            kill_descendants(self._process.pid)
        self._signal(signal.SIGKILL)


class ConductorInRoom(ConductorProcess):
    """A conductor that is a fork (grader.trial.fork_server) in a new room."""

    def __init__(self, ros: installation.Ros, nodes: int, errors: IO[bytes], *, share: bool) -> None:
        """Create the room, and request the conductor and the processes of `nodes` nodes from the fork servers.

        `share` is the argument of fork_client.conductors.

        Raises:
            HolderError: bubblewrap could not create the room.
            OSError: the system refused an operation, for example because too many files are open.
        """
        super().__init__()
        with ExitStack() as stack:
            self._group: ControlGroup = stack.enter_context(control_group(NODE_LIMITS))
            user = stack.enter_context(cell_user())
            view = bubblewrap.View(bubblewrap.ros_view(ros, Path(grader.__file__).parent).read_only)
            self._room = Holder(
                lambda info_fd: self._group.joined(
                    bubblewrap.room(HOLDER, view, env=_PLAIN, user=user, info_fd=info_fd)
                )
            )
            stack.callback(self._room.close)
            with ExitStack() as passed:
                room = self._room.await_ready()
                passed.callback(os.close, room)
                asks, answers = map(passed.enter_context, socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET))
                its_stdin, stdin = os.pipe()
                stdout, its_stdout = os.pipe()
                self.stdin, self.stdout = os.fdopen(stdin, "wb"), os.fdopen(stdout, "rb")
                for descriptor in (its_stdin, its_stdout):
                    passed.callback(os.close, descriptor)
                groups = [str(folder) for folder in self._group.folders]
                wanted = [(resource.RLIMIT_AS, MOST_MEMORY), (resource.RLIMIT_FSIZE, MOST_ERRORS)]
                limits = [(which, allowed(which, most)) for which, most in wanted]
                conductor = {"groups": groups, "user": user, "limits": limits, "home": str(bubblewrap.HOME)}
                descriptors = [room, its_stdin, its_stdout, errors.fileno(), asks.fileno()]
                self._forks = [fork_client.conductors(ros, share=share).request(conductor, descriptors)]
                stack.callback(self._forks[0].close)
                if nodes:
                    self._forks += [fork_client.nodes(ros).request(about_nodes(groups, nodes), [answers.fileno()])]
                    stack.callback(self._forks[1].close)
            self._stack = stack.pop_all()

    def out_of_memory(self) -> bool:
        """Return whether the kernel killed a process because the control group used too much memory."""
        return self._group.out_of_memory()

    def pids(self) -> tuple[int, ...]:
        """Return the ids of bubblewrap, of the conductor, and of the process that forks the nodes."""
        forked = [fork.await_started() for fork in self._forks]
        return (self._room.pid, *(pid for pid in forked if pid is not None))

    def wait(self, timeout: float) -> int:
        """Wait until the conductor has exited, and return its exit code."""
        return self._forks[0].wait(timeout)

    def close(self) -> None:
        """Kill all processes of the room, and remove the control group."""
        self.kill()
        _close(self.stdin, self.stdout)
        self._stack.close()

    def _signal(self, number: int) -> None:
        self._forks[0].signal(number)

    def _kill(self) -> None:
        self._room.kill()


def about_nodes(groups: list[str], nodes: int) -> dict[str, Any]:
    """Return the request for the fork server of the nodes (grader.trial.fork_server)."""
    return {
        "groups": groups,
        "nodes": nodes,
        "limits": list(resource_limits(NODE_LIMITS, in_cell=True).items()),
        "filter": base64.b64encode(system_calls.program()).decode(),
        "workspace": str(bubblewrap.WORKSPACE),
    }


def _close(*pipes: IO[bytes]) -> None:
    for pipe in pipes:
        with suppress(BrokenPipeError):
            pipe.close()
