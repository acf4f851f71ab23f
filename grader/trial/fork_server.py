"""Fork conductors or nodes from a process that has already imported rclpy, so that a trial need not import it.

A grader has two fork servers: one forks the conductors of its trials, and the other forks the nodes
(grader.trial.launcher). For marks, they are started separately, because a conductor reads the messages of a student's
node, and the node must not be able to find out the memory layout of the conductor. When learners check their own work,
the server for conductors is a fork of the server for nodes, so that rclpy is imported only once. A server has no data
about the trials. Before its forks enter the sandbox, they read only the request and, for a node, file descriptors from
the conductor. Student code never runs outside the sandbox.

The server runs outside the sandbox. It reads requests from the grader on a socket, each with file descriptors:

- **conductor**: JSON with the control groups, the user, the limits and HOME. The file descriptors are a process in the
  room (pidfd_open(2)), standard input, output and error, the socket on which the conductor requests nodes, and the
  socket for the result;
- **node**: JSON with the control groups, the limits, the system call filter, the workspace and the number of nodes. The
  file descriptors are the socket on which the conductor requests nodes, and the socket for the result. For each node,
  the conductor sends only file descriptors: a process in the node's cell, standard input, output and error, and the
  socket for the result. The conductor sends them before it starts any node;
- **conductors**, only to the server for nodes: JSON with the environment variables of conductors. The file descriptors
  are the socket on which the fork, the server for conductors, reads its requests, and a socket that is not used.

Each conductor and each node has its own socket for the result. On this socket, the server sends STARTED with a file
descriptor of the new process, and STATUS when the process has ended. If the other end of the socket is closed, the
process is killed. Each **node** request also has such a socket. On this socket, the process that forks the nodes sends
only STARTED.
"""

from __future__ import annotations

import base64
import gc
import importlib
import json
import os
import socket
import sys
import traceback
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.common.linux_calls import pidfd_open
from grader.sandbox import entering
from grader.trial import launcher
from grader.trial.fork import STARTED
from grader.trial.forking import fork_supervised, next_request

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

NODES_SOCKET = 3
"""The descriptor of the socket on which a conductor requests nodes."""
CONDUCTORS, NODES = 6, 5
"""The number of file descriptors that are sent to request a conductor, and to request each node."""
CELLS_USER = 1000
"""The user id of the processes in a cell (bubblewrap.cell)."""
_AHEAD = ("grader.trial.conductor", "grader.trial.simulated", "grader.trial.wall", "grader.trial.without_node")
"""The main modules of a conductor. They import all other modules that a conductor needs."""

_CHECKED = "ros_python_check_fields"
"""The variable in which the module of a message class keeps the environment variable with the same name in capitals."""


def main() -> None:
    """Import everything, and serve requests until the socket is closed.

    The arguments are "conductor" or "node", and the descriptor of the socket.
    """
    kind, requests = sys.argv[1], socket.socket(fileno=int(sys.argv[2]))
    Path("/proc/self/comm").write_text("python3", "ascii")  # otherwise, `ps` shows the name of the loader
    postponed, problem = _try(launcher.import_ahead if kind == "node" else _import_conductor)
    entering.allow_inspection(allow=False)
    order, passed = _next_order(requests)
    if "conductors" in order:
        kind = "conductor"
        os.setsid()  # no fork shares a process group with the server for nodes
        _set_environment(order["conductors"])
        if not problem:
            _, problem = _try(_import_conductor)
        own_requests, result = passed
        os.close(result)
        order, passed = _next_order(socket.socket(fileno=own_requests))
    with _exit_on_errors():
        (_enter_cell if kind == "node" else _enter_room)(order, problem, *passed)
    if kind == "node":
        order.clear()
        launcher.run(postponed)
    else:
        from grader.trial import conductor

        conductor.main(socket.socket(fileno=NODES_SOCKET))
        os._exit(0)  # nobody needs what Python and Fast DDS would clean up


def _try(import_: Callable[[], list[launcher.Postponed]]) -> tuple[list[launcher.Postponed], str]:
    """Call a function that imports modules. Return its result and, if it fails, the traceback."""
    gc.disable()  # imports leave hardly any garbage
    try:
        return import_(), ""
    except Exception:  # a part of ROS 2 is missing, for example
        return [], traceback.format_exc()


def _set_environment(variables: dict[str, str]) -> None:
    """Set environment variables, also in message classes that have already been imported and have read a variable."""
    os.environ.update(variables)
    for module in list(sys.modules.values()):
        if _CHECKED in getattr(module, "__dict__", ()):
            setattr(module, _CHECKED, variables[_CHECKED.upper()])


@contextmanager
def _exit_on_errors() -> Iterator[None]:
    """If an error occurs, print one line and end this process.

    No traceback is printed, because Python would read source files, and perhaps import modules, from the file system
    that this process sees. Student code may have mounted it (entering.enter), and the process may run as root.
    """
    try:
        yield
    except BaseException as error:
        with suppress(OSError):
            os.write(2, f"{type(error).__name__}: {error}\n".encode())
        os._exit(1)


def _import_conductor() -> list[launcher.Postponed]:
    with launcher.postponed() as modules:
        for name in _AHEAD:
            importlib.import_module(name)
    return modules


def _next_order(requests: socket.socket) -> tuple[dict[str, Any], list[int]]:
    """Wait for requests. For each request, fork this process, and return the request in the child process only.

    The child process joins the control groups of the trial.
    """
    request, passed = next_request(requests)
    order = json.loads(request)
    for folder in order["groups"]:
        with suppress(OSError):
            Path(folder, "cgroup.procs").write_text(str(os.getpid()), "ascii")
    return order, passed


def _enter_room(order: dict[str, Any], problem: str, room: int, *passed: int) -> None:
    """Turn this process into a process in the room."""
    *streams, result = passed
    _report_to(streams[2], problem)
    entering.enter(room, cell=False)
    fork_supervised(result, [room, *streams])
    entering.keep(streams)
    entering.confine(order["limits"], user=order["user"])
    os.environ.update({"HOME": order["home"], "ROS_LOG_DIR": f"{order['home']}/log"})
    os.chdir(order["home"])


def _enter_cell(order: dict[str, Any], problem: str, conductors: int, result: int) -> None:
    """Turn this process into a process in the cell of a node."""
    entering.pass_descriptors(socket.socket(fileno=result), STARTED, [pidfd_open(os.getpid())])
    descriptors = _next_node(socket.socket(fileno=conductors), order["nodes"])
    cell, *streams, its_result = descriptors
    _report_to(streams[2], problem)
    by_root = os.geteuid() == 0
    entering.enter(cell, cell=True)
    fork_supervised(its_result, [cell, *streams])
    entering.keep(streams)
    call_filter = base64.b64decode(order["filter"])
    entering.confine(order["limits"], user=CELLS_USER if by_root else None, call_filter=call_filter)
    entering.sacrifice()
    os.chdir(order["workspace"])
    os.environ["PWD"] = order["workspace"]
    del sys.orig_argv[1:]
    for name in [name for name in sys.modules if name.partition(".")[0] == "grader"]:
        del sys.modules[name]


def _report_to(stderr: int, problem: str) -> None:
    """Redirect standard error to this descriptor. If the server had a problem at start-up, print it and exit."""
    os.dup2(stderr, 2)
    if problem:
        os.write(2, problem.encode())
        os._exit(1)


def _next_node(conductor: socket.socket, nodes: int) -> list[int]:
    """Wait for the cells of the nodes. For each cell, fork, and return the cell's descriptors in the child process."""
    for _ in range(nodes):
        data, descriptors, *_ = socket.recv_fds(conductor, 1, NODES)
        if not data:  # the conductor has exited
            os._exit(0)
        if os.fork() == 0:
            conductor.close()
            entering.end_with_parent()
            return descriptors
        for descriptor in descriptors:
            os.close(descriptor)
    conductor.close()
    for _ in range(nodes):
        os.wait()
    os._exit(0)


if __name__ == "__main__":
    main()
