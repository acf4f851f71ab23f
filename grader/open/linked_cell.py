"""A sandbox cell in which a node runs, with a relay to other nodes on this machine (dds_relay.py)."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from selectors import DefaultSelector
from typing import TYPE_CHECKING

import grader.graph
import grader.trial
from grader.common.interpreter import interpreter
from grader.errors import MachineError
from grader.graph import announcements
from grader.open.dds_ports import reserve
from grader.open.dds_relay import Relay
from grader.ros import installation
from grader.sandbox import bubblewrap
from grader.sandbox.control_group import control_group
from grader.sandbox.limits import NODE_LIMITS
from grader.sandbox.system_calls import call_filter
from grader.sandbox.usage import Guard, family
from grader.sandbox.user import cell_user
from grader.trial.launchers import LaunchError, await_launcher

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from grader.ros.installation import Ros

LIMITS = replace(NODE_LIMITS, cpu_s=4 * 3600)
"""The limits of a node in a trial, but with more CPU time."""
PROFILE = Path(grader.graph.__file__).with_name("loopback.xml")
"""The Fast DDS profile for a network that has only 127.0.0.1."""
LAUNCHER = Path(grader.trial.__file__).with_name("launcher.py")
SOCKETS = Path(__file__).with_name("cell_sockets.py")
FAST_DDS = "rmw_fastrtps_cpp"
_MOST_SOCKETS = 250


@dataclass
class LinkedCell:
    """The process of the launcher in its cell.

    The caller must call the function in the `data` of each key that `selector` reports as ready.
    """

    process: subprocess.Popen[bytes]
    selector: DefaultSelector
    first: int = 0
    """The process id of the launcher, which becomes the node."""
    out_of: str | None = None
    """The limit that the node has exceeded, if it was stopped for this reason."""

    def interrupt(self) -> None:
        """Send SIGINT to the process group of the node, as Ctrl-C does.

        If the node has not started yet, kill the cell.
        """
        with suppress(ProcessLookupError):
            if os.getpgid(self.first) == self.first:
                os.killpg(self.first, signal.SIGINT)
            else:
                self.kill()

    def kill(self) -> None:
        """Kill the cell and all its processes."""
        # Kill the whole process group: while bubblewrap is starting, its child processes do not yet exit together with
        # it.
        with suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)

    def await_ready(self) -> None:
        """Wait until the launcher is ready to receive the data about the node that it must run.

        Raises:
            MachineError: the launcher has exited.
        """
        assert self.process.stdout is not None
        try:
            await_launcher(self.process.stdout)
        except LaunchError as error:
            lines = str(error).splitlines() or ["no message"]
            message = f"The sandbox did not start: {lines[-1].rstrip('.')}. Check this machine with `grader doctor`."
            raise MachineError(message) from error
        # Only bubblewrap has forked so far, and each of its processes has one child.
        self.first = list(family(self.process.pid))[-1]

    def over(self, what: str) -> None:
        """Kill the cell because its node has exceeded a limit."""
        self.out_of = what
        self.kill()


def linkable() -> bool:
    """Return whether a node in a cell can reach the nodes of this machine. This requires a sandbox and Fast DDS.

    The course's own ROS 2 always uses Fast DDS.

    Raises:
        MachineError: ROS 2 was not found.
    """
    other = (os.environ.get("RMW_IMPLEMENTATION") or FAST_DDS) != FAST_DDS
    return not (other and installation.find_ros().kind == "sourced") and bubblewrap.usable()


def environment(ros: Ros, domain: int, overlays: Sequence[Path] = ()) -> dict[str, str]:
    """Return the environment of a node in a linked cell. `overlays` are install folders inside the cell."""
    env = installation.environment(ros, home=bubblewrap.HOME, overlays=overlays, domain=domain)
    # The profile has the settings of LOCALHOST, but without shared memory, which the cell does not share.
    reach = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT", "FASTRTPS_DEFAULT_PROFILES_FILE": str(PROFILE)}
    return {**env, **reach, announcements.PORT: "0"}


@contextmanager
def linked_cell(ros: Ros, domain: int) -> Iterator[LinkedCell]:
    """Start trial/launcher.py in a cell, with a relay to this ROS domain. Leaving the context stops the cell.

    Raises:
        MachineError: the cell could not be started, or too few ports are free.
    """
    with ExitStack() as stack:
        ports = reserve(domain)
        for each in ports.own:
            stack.callback(each.close)
        ours, theirs = socket.socketpair()
        stack.enter_context(ours)
        env = environment(ros, domain)
        launch = interpreter(str(LAUNCHER), python=str(ros.python), env=env, searches=True)
        listed = ",".join(map(str, ports.others))
        first = interpreter(
            *(str(SOCKETS), str(theirs.fileno()), listed, *launch.argv),
            python=str(ros.python),
            env=launch.env,
            searches=True,
        )
        view = bubblewrap.ros_view(ros, PROFILE, LAUNCHER, SOCKETS)
        group = stack.enter_context(control_group(LIMITS))
        user = stack.enter_context(cell_user())
        with theirs, call_filter() as filter_fd:
            command = bubblewrap.lone_cell(
                first.argv, view, env=first.env, limits=LIMITS, user=user, filter_fd=filter_fd
            )
            process = subprocess.Popen(
                group.joined(command),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                pass_fds=[theirs.fileno(), *([] if filter_fd is None else [filter_fd])],
                start_new_session=True,
            )
        cell = LinkedCell(process, stack.enter_context(DefaultSelector()))
        stack.callback(process.wait)
        stack.callback(cell.kill)
        _, descriptors, _, _ = socket.recv_fds(ours, 1, _MOST_SOCKETS)
        inside = [socket.socket(fileno=each) for each in descriptors]
        cell.await_ready()
        stack.callback(Relay(cell.selector, domain, ports, inside).close)
        stack.callback(Guard([process.pid], LIMITS, cell.over).close)
        yield cell
