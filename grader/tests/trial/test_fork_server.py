"""Nodes and conductors are forks. A fork has what bubblewrap gives the programs that it starts, and nothing more."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from grader.common.interpreter import interpreter
from grader.errors import MachineError
from grader.ros.installation import FASTDDS_PROFILE, find_ros
from grader.ros.underlay import with_turtlesim
from grader.sandbox import bubblewrap
from grader.sandbox.limits import NODE_LIMITS
from grader.sandbox.system_calls import call_filter
from grader.sandbox.usage import family
from grader.sandbox.user import cell_user
from grader.tests.trial.forks import WALL, children, forks, kill, mapped, run
from grader.tests.waiting import HANG_S, only_child, until, until_gone
from grader.trial import fork_client
from grader.trial.trial import Trial

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
SELF = """#!/usr/bin/env python3
import ctypes, json, os, resource, signal, sys
death = ctypes.c_int()
ctypes.CDLL(None).prctl(2, ctypes.byref(death), 0, 0, 0)
COUNTED = ("Pid", "PPid", "Tgid", "Ngid", "NStgid", "NSpid", "NSpgid", "NSsid", "FDSize", "Cpus", "Mems", "Threads")
COUNTED += ("Vm", "Rss", "Huge", "voluntary", "nonvoluntary", "Name", "State", "Speculation", "SigQ", "SigCgt", "x86")
status = [line.split(":\\t", 1) for line in open("/proc/self/status").read().splitlines() if ":\\t" in line]
mounts = [line.split() for line in open("/proc/self/mountinfo")]
try:
    terminal = os.open("/dev/tty", os.O_RDWR)
except OSError as error:
    terminal = error.errno
print(json.dumps({
    "status": {name: value for name, value in status if not name.startswith(COUNTED)},
    "limits": [resource.getrlimit(kind) for kind in range(16)],
    "groups": open("/proc/self/cgroup").read(),
    "signal when the parent ends": death.value,
    "killed first": open("/proc/self/oom_score_adj").read(),
    "descriptors": [name for name in os.listdir("/proc/self/fd") if os.path.exists("/proc/self/fd/" + name)],
    "top": sorted(os.listdir("/")),
    "mounts": sorted([mount[4], *mount[5].split(","), mount[mount.index("-") + 1]] for mount in mounts),
    "interfaces": os.listdir("/proc/self/net/dev_snmp6") if os.path.isdir("/proc/self/net/dev_snmp6") else [],
    "terminal": terminal,
    "folder": os.getcwd(),
    "host": os.uname().nodename,
    "priority": [os.nice(0), os.sched_getscheduler(0)],
}, sort_keys=True))
"""


@pytest.mark.parametrize("share", [False, True])
def test_a_node_cannot_do_more_than_a_program_that_bubblewrap_starts(*, share: bool) -> None:
    recording = run(SELF, share=share)
    assert recording.stderr.text == ""
    forked = json.loads(recording.stdout.text)
    view = bubblewrap.ros_view(with_turtlesim(find_ros()), FASTDDS_PROFILE)
    env = {"PATH": "/usr/bin:/bin", "PYTHONUNBUFFERED": "1"}
    with call_filter() as filter_fd, cell_user() as user:
        command = bubblewrap.lone_cell(
            [sys.executable, "-c", SELF], view, env=env, limits=NODE_LIMITS, user=user, filter_fd=filter_fd
        )
        passed = () if filter_fd is None else (filter_fd,)
        done = subprocess.run(command, capture_output=True, text=True, check=True, pass_fds=passed, env=env)
    assert forked == json.loads(done.stdout)


def test_a_node_cannot_reach_the_file_of_the_interpreter_outside_of_its_cell() -> None:
    script = "import os\nprint(*os.stat('/proc/self/exe')[1:3], open('/proc/self/comm').read())\n"
    inode, device, name = run(f"#!/usr/bin/env python3\n{script}").stdout.text.split()
    own = Path(sys.executable).stat()
    assert (int(inode), int(device)) != (own.st_ino, own.st_dev)
    assert name == "python3"


def test_a_traceback_shows_the_program_alone() -> None:
    stderr = run("#!/usr/bin/env python3\ndef main():\n    exec('1 / 0')\n\nmain()\n").stderr.text
    assert [line.split(",")[0].strip() for line in stderr.splitlines() if "File" in line] == [
        'File "/ws/install/package/lib/package/node"',
        'File "/ws/install/package/lib/package/node"',
        'File "<string>"',
    ]


@pytest.mark.parametrize("share", [False, True])
def test_nodes_do_not_share_random_numbers_and_inherit_no_module_of_the_grader(*, share: bool) -> None:
    script = """#!/usr/bin/env python3
import random, sys
frame = sys._getframe()
while frame is not None:
    assert not any("c" + "group/" in str(value) for value in frame.f_locals.values()), frame.f_locals
    frame = frame.f_back
print(random.random(), [name for name in sys.modules if name.startswith("grader")], sys.argv, sys.orig_argv[1:])
"""
    first, second = (run(script, share=share).stdout.text.split(" ", 1) for _ in range(2))
    assert first[0] != second[0]
    assert first[1] == second[1] == "[] ['/ws/install/package/lib/package/node'] []\n"


@pytest.mark.parametrize(
    ("end", "code"),
    [("sys.exit(200)", 200), ("os.kill(os.getpid(), 9)", -9), ("raise KeyError", 1), ("", 0), ("os._exit(137)", 137)],
)
def test_the_exit_code_is_that_of_the_node(end: str, code: int) -> None:
    assert run(f"#!/usr/bin/env python3\nimport os, sys\n{end}\n").end.exit_code == code


def test_a_node_does_not_have_the_memory_layout_of_the_conductor() -> None:
    ros = with_turtlesim(find_ros())
    with Trial(WALL, ros, in_cell=True) as first, Trial(WALL, ros, in_cell=True) as second:
        for trial in (first, second):
            trial.await_ready()
        conductors, nodes = zip(*(forks(trial) for trial in (first, second)), strict=True)
        layouts = [mapped(pid) for pid in (*conductors, *nodes)]
    assert layouts[0] == layouts[1], "the conductors are not forks of one process"
    assert layouts[2] == layouts[3], "the nodes are not forks of one process"
    assert not layouts[0] & layouts[2]


@pytest.mark.parametrize("share", [False, True])
def test_signals_to_their_process_group_reach_no_other_trial(*, share: bool) -> None:
    with Trial(WALL, with_turtlesim(find_ros()), in_cell=True, share=share) as trial:
        trial.await_ready()
        _, conductor, forks_nodes = trial._conductor.pids()
        supervisor = only_child(forks_nodes)
        for pid in (conductor, only_child(supervisor)):
            assert os.getpgid(pid) == os.getsid(pid) == pid


def test_a_node_ends_with_the_processes_that_fork_and_supervise_it() -> None:
    with Trial(WALL, with_turtlesim(find_ros()), in_cell=True) as trial:
        trial.await_ready()
        forks_nodes = trial._conductor.pids()[2]
        supervisor = only_child(forks_nodes)
        node = only_child(supervisor)
        os.kill(forks_nodes, signal.SIGKILL)
        until_gone(supervisor)
        until_gone(node)


def test_the_environment_of_the_grader_is_not_in_a_room(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GRADER_TOKEN", "secret")
    with Trial(WALL, with_turtlesim(find_ros()), in_cell=True) as trial:
        trial.await_ready()
        for pid in family(trial._conductor.pids()[0]):
            assert b"GRADER_TOKEN" not in Path(f"/proc/{pid}/environ").read_bytes()


def test_a_fork_ends_when_nobody_waits_for_it() -> None:
    with Trial(WALL, with_turtlesim(find_ros()), in_cell=True) as trial:
        trial.await_ready()
        conductor, _ = forks(trial)
        trial._conductor._forks[0].close()  # type: ignore[attr-defined]
        until_gone(conductor)


def waits(pid: int) -> bool:
    """Return whether a process with one thread sleeps, as a server that waits for a request."""
    return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "S"


def test_a_server_keeps_nothing_of_a_trial_and_has_no_terminal() -> None:
    ros = with_turtlesim(find_ros())
    observed = []
    kept: dict[int, list[int]] = {}
    for server in (fork_client.conductors(ros, share=False), fork_client.nodes(ros)):
        server.start()
        assert server._process is not None
        kept[server._process.pid] = children(server._process.pid)  # such as the server for conductors of other tests
    for _ in range(2):
        run("#!/usr/bin/env python3\n")
        for pid in kept:
            assert os.getsid(pid) == pid
            for forked in set(children(pid)) - set(kept[pid]):
                until_gone(forked)
            until(partial(waits, pid))  # before that, it may not have closed what it has passed on
            observed.append(len(list(Path(f"/proc/{pid}/fd").iterdir())) if os.geteuid() == 0 else 0)
    assert observed[:2] == observed[2:]


def test_a_server_looks_for_no_files_where_another_user_can_create_them() -> None:
    """Its forks keep its first environment in /proc/PID/environ."""
    with Trial(WALL, with_turtlesim(find_ros()), in_cell=True) as trial:
        trial.await_ready()
        for pid in forks(trial):
            lines = Path(f"/proc/{pid}/environ").read_text().split("\0")
            env = dict(line.split("=", 1) for line in lines if line)
            assert (env["HOME"], env["ROS_LOG_DIR"]) == ("/nonexistent", "/nonexistent/log")


def test_all_processes_of_a_trial_are_in_its_control_group() -> None:
    with Trial(WALL, with_turtlesim(find_ros()), in_cell=True) as trial:
        trial.await_ready()
        folders = trial._conductor._group.folders  # type: ignore[attr-defined]
        if not folders:
            pytest.skip("there are no control groups here")
        for folder in folders:
            inside = (folder / "cgroup.procs").read_text().split()
            assert [pid for pid in family(*trial._conductor.pids()) if str(pid) not in inside] == []


def test_a_server_that_was_killed_is_started_again() -> None:
    ros = with_turtlesim(find_ros())
    run("#!/usr/bin/env python3\n")
    for server in (fork_client.conductors(ros, share=False), fork_client.nodes(ros)):
        kill(server)
    assert run("#!/usr/bin/env python3\nprint('again')\n").stdout.text == "again\n"


@pytest.mark.parametrize("share", [False, True])
def test_a_missing_part_of_ros_is_named(*, share: bool) -> None:
    ros = replace(find_ros(), underlay=None, prefixes=(), python_path=())
    with Trial(WALL, ros, in_cell=True, share=share) as trial, pytest.raises(MachineError, match="No module named"):
        trial.await_ready()


SERVER = """
import os, sys
from grader.ros.installation import find_ros
from grader.ros.underlay import with_turtlesim
from grader.trial import fork_client
from grader.trial.trial import Plan, Trial
from grader.trial.recording import Pose

ros = with_turtlesim(find_ros())
share = sys.argv[2] == "share"
with Trial(Plan("wall", Pose(5.5, 5.5, 0.0), None, 1.0), ros, in_cell=True, share=share) as trial:
    trial.await_ready()
    servers = [fork_client.nodes(ros)] if share else [fork_client.conductors(ros, share=False), fork_client.nodes(ros)]
    print(*(server._process.pid for server in servers), *trial._conductor.pids(), flush=True)
    os.kill(os.getpid(), int(sys.argv[1]))
"""


@pytest.mark.parametrize("mode", ["share", "apart"])
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_the_servers_and_their_forks_end_with_the_grader(number: int, mode: str) -> None:
    start = interpreter("-c", SERVER, str(number), mode, searches=True)
    done = subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=False, timeout=HANG_S)
    assert done.returncode == -number, done.stderr
    pids = [int(pid) for pid in done.stdout.split()]
    assert len(pids) == (4 if mode == "share" else 5)
    for pid in pids:
        until_gone(pid)
