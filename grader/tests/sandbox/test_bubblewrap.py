from __future__ import annotations

import gc
import json
import subprocess
import sys
from pathlib import Path

import pytest

from grader import cli
from grader.errors import MachineError
from grader.learner import exercise_argument
from grader.sandbox import bubblewrap, process
from grader.sandbox.limits import MIB, Limits
from grader.sandbox.system_calls import DENIED, call_filter, program
from grader.sandbox.user import cell_user
from grader.tests.waiting import HANG_S

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
ENV = {"PATH": "/usr/bin:/bin", "HOME": str(bubblewrap.HOME)}


SEEN = bubblewrap.View((Path(sys.base_prefix), Path(sys.prefix)))


def run(
    code: str,
    limits: Limits = Limits(),  # noqa: B008
    view: bubblewrap.View = SEEN,
) -> process.Finished:
    """Run Python code in a sandbox cell."""
    with call_filter() as filter_fd, cell_user() as user:
        command = bubblewrap.lone_cell(
            [sys.executable, "-c", code], view, env=ENV, limits=limits, user=user, filter_fd=filter_fd
        )
        return process.run(
            command,
            env=ENV,
            timeout_s=HANG_S,
            most_stdout=10**6,
            most_stderr=10**5,
            pass_fds=() if filter_fd is None else (filter_fd,),
            watch=limits,
        )


def test_a_cell_is_an_ordinary_user_without_privileges() -> None:
    code = """
import json, os
status = dict(line.split(":\\t", 1) for line in open("/proc/self/status").read().splitlines() if ":\\t" in line)
print(json.dumps([os.getuid(), os.getgroups(), *map(status.get, ("CapEff", "CapBnd", "NoNewPrivs", "Seccomp"))]))
"""
    assert json.loads(run(code).stdout) == [1000, [], "0" * 16, "0" * 16, "1", "2"]


def test_a_cell_sees_only_its_own_processes_and_no_disk() -> None:
    code = """
import json, os
print(json.dumps([sorted(name for name in os.listdir("/proc") if name.isdigit()), sorted(os.listdir("/"))]))
"""
    processes, top = json.loads(run(code).stdout)
    assert processes == ["1", "2"]
    expected = {"bin", "dev", "etc", "lib", "lib32", "lib64", "proc", "sbin", "tmp", "usr", "ws"}
    assert set(top) <= expected | {Path(path).parts[1] for path in (sys.prefix, sys.base_prefix)}


def test_a_room_has_shared_memory_because_lttng_needs_it() -> None:
    argv = ["sh", "-c", "touch /dev/shm/lttng-ust-wait-6 && mount | grep -c ' /dev/shm .*size=262144k'"]
    with cell_user() as user:
        command = bubblewrap.room(argv, SEEN, env=ENV, user=user)
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "1\n"), done.stderr


def test_a_cell_sees_only_named_parts_of_a_hidden_folder(tmp_path: Path) -> None:
    """A node uses the libraries in the grader's environment, but it needs only the launcher from the grader itself."""
    package = tmp_path / "site-packages" / "grader"
    for name in ("trial/launcher.py", "trial/rest.py", "solutions/a.py", "fastdds.xml"):
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(name)
    observed = (*SEEN.read_only, tmp_path / "site-packages", package / "trial/launcher.py", package / "fastdds.xml")
    code = f"""
import pathlib
below = pathlib.Path({str(package)!r})
print(sorted(str(path.relative_to(below)) for path in below.rglob("*")), (below / "fastdds.xml").read_text())
(below / "more").mkdir()
"""
    done = run(code, view=bubblewrap.View(observed, hidden=(package,)))
    assert done.stdout.decode() == "['fastdds.xml', 'trial', 'trial/launcher.py'] fastdds.xml\n"
    assert b"Read-only file system" in done.stderr


def test_a_cell_inherits_no_descriptor() -> None:
    done = run("import os; print(len([fd for fd in os.listdir('/proc/self/fd') if int(fd) > 2]))")
    assert int(done.stdout) == 1  # listing the folder opens a descriptor


@pytest.mark.parametrize("place", ["/", "/usr", "/etc", "/dev", sys.prefix])
def test_a_cell_can_only_write_to_its_writable_folders(place: str) -> None:
    done = run(f"open({place + '/hostile'!r}, 'w')")
    assert b"Read-only file system" in done.stderr


def test_a_cell_that_uses_too_much_memory_in_total_is_ended() -> None:
    code = "blocks = [bytearray(60 << 20) for _ in range(4)]; import time; time.sleep(600)"
    done = run(code, Limits(total_memory=128 * MIB))
    assert (done.out_of, done.timed_out) == ("memory", False)


def test_a_cell_with_too_many_files_is_ended() -> None:
    code = "[open(f'/tmp/{n}', 'w').close() for n in range(2000)]; import time; time.sleep(600)"
    done = run(code, Limits(files=1000))
    assert (done.out_of, done.timed_out) == ("files", False)


UDP = """
receivers = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(60)]
sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for receiver in receivers:
    receiver.bind(("127.0.0.1", 0))
    for _ in range(10 * sends):
        sender.sendto(bytes(20_000), receiver.getsockname())
"""
TCP = """
server, kept = socket.create_server(("127.0.0.1", 0)), []
for _ in range(30):
    client = socket.create_connection(server.getsockname())
    kept += [client, server.accept()[0]]
    client.setblocking(False)
    with contextlib.suppress(BlockingIOError):
        for _ in range(20 * sends):
            client.send(bytes(50_000))
"""


@pytest.mark.parametrize("fill", [UDP, TCP], ids=["UDP", "TCP"])
def test_data_that_waits_in_sockets_counts_as_memory(fill: str) -> None:
    code = f"import contextlib, socket, time{fill}time.sleep(1.0 + 600.0 * sends)"
    limits = Limits(total_memory=12 * MIB)
    assert [run(f"sends = {sends}\n{code}", limits).out_of for sends in (0, 1)] == [None, "memory"]


def test_shared_memory_without_a_file_is_refused() -> None:
    code = """
import mmap
for target in ("shared", "zero"):
    try:
        mmap.mmap(-1 if target == "shared" else open("/dev/zero", "r+b").fileno(), 4096)
    except PermissionError:
        print(target)
mmap.mmap(-1, 4096, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
with open("file", "w+b") as file:
    file.write(bytes(4096))
    mmap.mmap(file.fileno(), 4096)
"""
    assert run(code).stdout == b"shared\nzero\n"


def test_shared_memory_of_a_file_counts_as_memory() -> None:
    code = """
import mmap, time
with open("file", "w+b") as file:
    file.truncate(30_000_000)
    shared = mmap.mmap(file.fileno(), 30_000_000)
    shared[:] = bytes(len(shared))
time.sleep(600)
"""
    assert run(code, Limits(total_memory=48 * MIB)).out_of == "memory"


def test_only_forbidden_calls_are_refused() -> None:
    numbers = sorted(number for group in DENIED.values() for number in group.values())
    code = f"""
import ctypes, errno
libc = ctypes.CDLL(None, use_errno=True)
for number in {numbers}:
    libc.syscall(number, -1, 0, 0, 0, 0, 0)
    assert ctypes.get_errno() == errno.EPERM, number
assert libc.syscall(435, 0, 0) == -1 and ctypes.get_errno() == errno.ENOSYS
assert libc.syscall(39) > 0
import socket, threading, subprocess
threading.Thread(target=int).start()
subprocess.run(["true"], check=True)
socket.socket(); socket.socket(socket.AF_UNIX); socket.socketpair(); socket.if_nameindex()
socket.socket(socket.AF_NETLINK, socket.SOCK_RAW | socket.SOCK_CLOEXEC)
for which in ((40, 1, 0), (2, 6, 0), (2, 10, 0), (2, 1, 132), (16, 3, 6), (16, 3, 15)):
    for call in (socket.socket, socket.socketpair):
        try:
            call(*which)
        except OSError as error:
            assert error.errno in (errno.EAFNOSUPPORT, errno.ESOCKTNOSUPPORT, errno.EPROTONOSUPPORT), which
        else:
            raise AssertionError(which)
print("held")
"""
    done = run(code)
    assert done.stdout == b"held\n", done.stderr


def test_the_filter_is_small() -> None:
    assert len(program()) < 4096


def test_grading_for_marks_refuses_without_a_sandbox(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bubblewrap, "program", lambda: None)
    with pytest.raises(MachineError, match=r"install -y bubblewrap.*--trust-submissions"):
        bubblewrap.require()
    assert bubblewrap.require(trusted=True) is False


def test_grader_check_without_a_sandbox_names_only_its_own_option(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bubblewrap, "program", lambda: None)
    monkeypatch.setattr(exercise_argument, "opened", lambda *_: (None, None))
    monkeypatch.setattr(gc, "disable", lambda: None)  # the other tests of this process need garbage collection
    with pytest.raises(MachineError) as raised:
        cli.check(confined=True)
    assert "Without --sandbox, this code runs with limits on time" in str(raised.value)
    assert "--trust-submissions" not in str(raised.value)


def test_trusted_code_runs_in_the_sandbox_if_there_is_one() -> None:
    assert bubblewrap.require(trusted=True) is True


def test_the_error_says_what_to_do_if_namespaces_are_forbidden(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    refused = tmp_path / "bwrap"
    refused.write_text("#!/bin/sh\necho 'bwrap: setting up uid map: Permission denied' >&2\nexit 1\n")
    refused.chmod(0o755)
    monkeypatch.setattr(bubblewrap, "program", lambda: str(refused))
    why = bubblewrap.why_unavailable()
    assert why is not None
    assert "setting up uid map" in why
    assert "AppArmor" in why


def test_a_machine_that_is_too_busy_is_not_a_machine_without_a_sandbox(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    slow = tmp_path / "bwrap"
    slow.write_text("#!/bin/sh\nexec sleep 600\n")
    slow.chmod(0o755)
    monkeypatch.setattr(bubblewrap, "program", lambda: str(slow))
    monkeypatch.setattr(bubblewrap, "_TRY_S", 0.1)
    with pytest.raises(MachineError, match="Try again when the machine is less busy"):
        bubblewrap.usable()
