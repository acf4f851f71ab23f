"""What a conductor under the control of a node attempts with the fork server of the nodes."""

from __future__ import annotations

import os
import socket
import subprocess
from pathlib import Path

import pytest

import grader
from grader.common.interpreter import interpreter
from grader.ros import installation, underlay
from grader.sandbox import bubblewrap
from grader.sandbox.user import cell_user
from grader.trial import fork_client
from grader.trial.conductor_process import about_nodes

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")

CONDUCTOR = """
import ctypes, os, signal, socket, sys, time
from pathlib import Path

libc = ctypes.CDLL(None, use_errno=True)
asks, what, sources = socket.socket(fileno=int(sys.argv[1])), sys.argv[2], Path(sys.argv[3])

def mount(folder):
    assert libc.mount(b"tmpfs", str(folder).encode(), b"tmpfs", 0, None) == 0

def trap():
    # A user, mounts, processes, a network, a host name and System V objects of its own.
    user, group = os.getuid(), os.getgid()
    assert libc.unshare(0x10000000 | 0x00020000 | 0x20000000 | 0x40000000 | 0x04000000 | 0x08000000) == 0
    Path("/proc/self/setgroups").write_text("deny")
    Path("/proc/self/uid_map").write_text(f"1000 {user} 1")
    Path("/proc/self/gid_map").write_text(f"1000 {group} 1")
    encodings = Path(__import__("encodings").__file__).parent
    mount(encodings)
    (encodings / "trap.py").write_text("open('/tmp/trapped', 'w').close()")
    mount(sources)
    (sources / "fork_server.py").write_text("# -*- coding: trap -*-\\n" * 400)
    if os.fork() == 0:
        os.write(ready, b"!")
        signal.pause()
    os.wait()

target = os.getpid()
if what == "nothing":
    socket.send_fds(asks, [b"."], [0])
    print(asks.recv(1), False)
    sys.exit()
if what == "trap":
    waits, ready = os.pipe()
    child = os.fork()
    if child == 0:
        trap()
    os.read(waits, 1)
    target = int(Path(f"/proc/{child}/task/{child}/children").read_text())
stdin, _, output, stdout = *os.pipe(), *os.pipe()
ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
result = stdout if what == "trap" else theirs.fileno()
if what == "grader":
    process = int.from_bytes(asks.getsockopt(socket.SOL_SOCKET, 77, 4), "little")  # SO_PEERPIDFD: who made the socket
    for reach in (lambda: signal.pidfd_send_signal(process, 9), lambda: os.setns(process, 0x00020000)):
        try:
            reach()
        except (OSError, AttributeError):
            continue
        sys.exit("reached the grader")
else:
    process = os.pidfd_open(target)
socket.send_fds(asks, [b"."], [process, stdin, stdout, stdout, result])
theirs.close()
os.close(stdout)
answer = b""
while chunk := os.read(output, 1000):
    answer += chunk
print(answer, Path("/tmp/trapped").exists())
"""


@pytest.mark.parametrize("what", ["trap", "room", "grader", "nothing"])
def test_a_conductor_under_the_control_of_a_node_gains_nothing_from_the_server_of_the_nodes(what: str) -> None:
    """It sends the server a process in namespaces that it has made, a process that is not in a cell, or too little.

    In the trap, a traceback would import a module of the conductor: Python reads the lines of source files, and the
    first line can name any encoding.
    """
    if what == "room" and os.geteuid() != 0:
        pytest.skip("a room of an ordinary user has namespaces of its own, and its processes have the same user")
    ros = underlay.with_turtlesim(installation.find_ros())
    asks, answers = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    package = Path(grader.__file__).parent
    view = bubblewrap.View(bubblewrap.ros_view(ros, package).read_only)
    arguments = (str(asks.fileno()), what, str(package / "trial"))
    code = interpreter("-c", CONDUCTOR, *arguments, python=str(ros.python), env={})
    with asks, cell_user() as user:
        with answers:
            forks = fork_client.nodes(ros).request(about_nodes([], 1), [answers.fileno()])
        command = bubblewrap.room(code.argv, view, env={"_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}, user=user)
        done = subprocess.run(command, pass_fds=[asks.fileno()], capture_output=True, text=True, check=False)
    forks.close()
    if "Protocol not available" in done.stderr:
        pytest.skip("this kernel has no SO_PEERPIDFD")
    assert done.returncode == 0, done.stderr
    refused = {"trap": "b'OSError: [Errno 88] ", "nothing": "b'' "}.get(what, "b'OSError: [Errno 22] ")
    assert done.stdout.startswith(refused), done.stdout
    assert done.stdout.endswith(" False\n"), done.stdout
