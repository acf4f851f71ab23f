"""What hostile nodes attempt with the fork servers, and with the forks of other submissions."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.common.interpreter import interpreter
from grader.ros import installation, underlay
from grader.sandbox import bubblewrap
from grader.tests.observed_host import Host, readable_by_others
from grader.tests.trial.forks import WALL, run
from grader.tests.waiting import HANG_S
from grader.trial.trial import WallTimeNeeded

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
as_user = pytest.mark.skipif(not readable_by_others(Path(__file__)), reason="other users cannot read this folder")

TRIALS = """
import io, sys, tarfile, threading
from grader.ros.installation import find_ros
from grader.ros.underlay import with_turtlesim
from grader.trial.recording import Pose
from grader.trial.trial import Plan, Trial

def run(script, duration_s, ready=lambda trial: None):
    tree = io.BytesIO()
    with tarfile.open(fileobj=tree, mode="w") as archive:
        member = tarfile.TarInfo("package/lib/package/node")
        script = "#!/usr/bin/env python3\\n" + script
        member.mode, member.size = 0o755, len(script.encode())
        archive.addfile(member, io.BytesIO(script.encode()))
    plan = Plan("wall", Pose(5.5, 5.5, 0.0), None, duration_s)
    with Trial(plan, with_turtlesim(find_ros()), in_cell=True) as trial:
        trial.await_ready()
        ready(trial)
        return trial.run("package", "node", tree.getvalue()).stdout.text
"""
"""A program begins with this text. It can then run a script as a node of a trial in wall time."""
IN_TRANSIT = """
import signal, socket
signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
kept, count = [], 0
try:
    while True:
        kept += socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
        try:
            while True:
                socket.send_fds(kept[-2], [b"x"], [0] * 100, socket.MSG_DONTWAIT)
                count += 100
        except BlockingIOError:
            pass
except OSError as error:
    print(count > 1000, error.errno, flush=True)
signal.sigwait({signal.SIGINT})
"""


@pytest.fixture
def folder() -> Iterator[Path]:
    """Return a new folder that other users can read, unlike pytest's own folders."""
    with tempfile.TemporaryDirectory(prefix="forks-", ignore_cleanup_errors=True) as made:
        Path(made).chmod(0o755)
        yield Path(made)


FORKS = """
import os, resource
from pathlib import Path
from grader.trial import fork_client

def children(pid):
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]

ros = with_turtlesim(find_ros())
plan = Plan("wall", Pose(5.5, 5.5, 0.0), None, 1.0)
"""
BESIDE = f"""{TRIALS}{FORKS}
import errno, signal, socket, time

def sockets_are_full():
    ours, theirs = socket.socketpair()
    with ours, theirs:
        try:
            socket.send_fds(ours, [b"x"], [0])
        except OSError as error:
            return error.errno == errno.ETOOMANYREFS
    return False

resource.setrlimit(resource.RLIMIT_NOFILE, (1024, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
results, trials = [], []
hostile = threading.Thread(target=lambda: results.append(run({IN_TRANSIT!r}, 600.0, trials.append)))
hostile.start()
try:
    deadline = time.monotonic() + {HANG_S}
    while not sockets_are_full():
        assert hostile.is_alive() and time.monotonic() < deadline
        time.sleep(0.01)
    honest = [run("print('honest')", 0.1) for _ in range(2)]
    assert sockets_are_full()
finally:
    os.kill(children(children(trials[0]._conductor.pids()[2])[0])[0], signal.SIGINT)
hostile.join()
print(*results, *honest, sep="", end="")
"""
"""A program that runs a hostile node, and honest nodes while the sockets of their user are full."""


@as_user
def test_a_node_that_fills_the_sockets_of_its_user_with_descriptors_does_not_stop_other_trials(folder: Path) -> None:
    host = Host(folder, underlay.ensure(installation.find_ros()), as_user=True)
    (host.work / "program.py").write_text(BESIDE, "utf-8")
    done = host.run([sys.executable, "/tmp/work/program.py"])
    assert done.stdout == "True 109\nhonest\nhonest\n", done.stderr


NOT_INSPECTED = f"""{TRIALS}{FORKS}
with Trial(plan, ros, in_cell=True) as trial:
    trial.await_ready()
    servers = [server._process.pid for server in (fork_client.conductors(ros, share=False), fork_client.nodes(ros))]
    _, conductor, forks_nodes = trial._conductor.pids()
    supervisors = [next(pid for pid in children(servers[0]) if conductor in children(pid)), *children(forks_nodes)]
    readable = [Path(f"/proc/{{pid}}/environ").stat().st_uid == os.getuid() for pid in
        (*servers, forks_nodes, *supervisors, conductor)]
print(readable, end="")
"""


@as_user
def test_other_processes_of_the_user_cannot_inspect_a_server_or_a_supervisor(folder: Path) -> None:
    """Linux gives the files of such a process in /proc to root. The conductor itself has nothing to hide."""
    host = Host(folder, underlay.ensure(installation.find_ros()), as_user=True)
    (host.work / "program.py").write_text(NOT_INSPECTED, "utf-8")
    done = host.run([sys.executable, "/tmp/work/program.py"])
    assert done.stdout == "[False, False, False, False, False, True]", done.stderr


USERS = f"""{TRIALS}{FORKS}
with Trial(plan, ros, in_cell=True) as trial:
    trial.await_ready()
    _, conductor, forks_nodes = trial._conductor.pids()
    for pid in (conductor, *children(children(forks_nodes)[0])):
        status = dict(line.split(":", 1) for line in Path(f"/proc/{{pid}}/status").read_text().splitlines())
        print(len({{*status["Uid"].split(), *status["Gid"].split()}}), int(status["Gid"].split()[0]) > 1000,
            status["Groups"].split())
"""


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can change its user")
def test_forks_of_root_have_neither_its_user_nor_any_of_its_groups() -> None:
    start = interpreter("-c", USERS, searches=True)
    command = ["setpriv", "--groups", "0,4242", *start.argv]
    done = subprocess.run(command, env=start.env, capture_output=True, text=True, check=True, timeout=HANG_S)
    assert done.stdout == "1 True []\n1 True []\n"


TOO_MANY = f"""{TRIALS}{FORKS}
from grader.errors import MachineError
with Trial(plan, ros, in_cell=True) as first:
    first.await_ready()
    server = fork_client.nodes(ros)._process.pid
    before = resource.prlimit(server, resource.RLIMIT_NPROC, (1, resource.getrlimit(resource.RLIMIT_NPROC)[1]))
    try:
        run("print('refused')", 0.1)
    except MachineError:
        print("refused")
    resource.prlimit(server, resource.RLIMIT_NPROC, before)
    print(run("print('honest')", 0.1), children(first._conductor.pids()[2]) != [], end="")
"""


@as_user
def test_a_server_that_cannot_fork_fails_one_trial_and_ends_no_other(folder: Path) -> None:
    host = Host(folder, underlay.ensure(installation.find_ros()), as_user=True)
    (host.work / "program.py").write_text(TOO_MANY, "utf-8")
    done = host.run([sys.executable, "/tmp/work/program.py"])
    assert done.stdout == "refused\nhonest\n True", done.stderr


HIDES = """#!/usr/bin/env python3
import ctypes, os, time
# The first process of the cell executes this code when it gets input: prctl(PR_SET_DUMPABLE, 0), pause() for ever.
place = int(open("/proc/1/syscall").read().split()[-1], 16)
with open("/proc/1/mem", "r+b", buffering=0) as memory:
    memory.seek(place)
    memory.write(bytes.fromhex("b89d000000bf0400000031f631d20f05" "b8220000000f05ebf7"))
with open("/proc/1/fd/0", "wb", buffering=0) as pipe:
    pipe.write(b"!")
for pid in [int(name) for name in os.listdir("/proc") if name.isdigit()]:
    if pid not in (1, os.getpid()):
        os.kill(pid, 9)
ctypes.CDLL(None).prctl(4, 0, 0, 0, 0)
for number in range(60_000):
    open(f"/dev/shm/{number}", "w").close()
time.sleep(600)
"""


def test_a_node_cannot_hide_its_disks() -> None:
    """The conductor looks at the disks through a process of the cell that it may inspect."""
    recording = run(HIDES, replace(WALL, duration_s=HANG_S))
    assert (recording.end.out_of, recording.stdout.text) == ("files", "")


SLEEPS = """#!/usr/bin/env python3
import ctypes, time
import rclpy
def work():
    ctypes.CDLL(None).prctl(4, 0, 0, 0, 0)
    time.sleep(0.05)
rclpy.init()
node = rclpy.create_node("sleeper")
node.create_timer(0.1, work)
rclpy.spin(node)
"""


def test_a_node_that_hides_what_it_waits_for_needs_wall_time() -> None:
    with pytest.raises(WallTimeNeeded, match="the node hides what it waits for"):
        run(SLEEPS, replace(WALL, clock="simulated", seed=3, duration_s=2.0))
