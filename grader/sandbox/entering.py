"""Enter a sandbox room or cell: a fork of a process that has imported everything becomes a process inside it.

bubblewrap creates the room or cell. `cat`, the first program in the room or cell, keeps it open. setns(2) moves a
process into the namespaces of `cat`, and the forks of this process are processes of the room or cell. A fork must then
give up the same rights that bubblewrap takes from the programs that it starts.

This module needs only the standard library and grader.common.linux_calls.
"""

from __future__ import annotations

import ctypes
import errno
import os
import resource
import signal
import socket
import struct
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

from grader.common.linux_calls import close_from, pidfd_open

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

HOLDER = ("cat",)
"""The program that keeps a room or cell open, until its standard input is closed."""
_DUMPABLE, _PARENT_DEATH, _SECCOMP, _BOUNDING_DROP, _NO_NEW_PRIVILEGES, _AMBIENT = 4, 1, 22, 24, 38, 47
"""Options of prctl(2)."""
_SECCOMP_FILTER, _AMBIENT_CLEAR = 2, 4
_NAMESPACES = {
    "cgroup": 0x02000000,
    "uts": 0x04000000,
    "ipc": 0x08000000,
    "user": 0x10000000,
    "pid": 0x20000000,
    "net": 0x40000000,
    "mnt": 0x00020000,
}
"""The namespaces in /proc/PID/ns, and their flags for setns(2)."""
_CAPABILITIES_VERSION_3 = 0x20080522
_LAST_CAPABILITY = 63
_C = ctypes.CDLL(None, use_errno=True)
_MOST_IN_TRANSIT = 65_536
_passing = Lock()


def why_impossible() -> str | None:
    """Return the reason why processes cannot enter a room or cell on this kernel, or None if they can.

    setns(2) with a pidfd needs Linux 5.8.
    """
    try:
        own = pidfd_open(os.getpid())
    except OSError as error:
        refused: int | None = error.errno
    else:
        refused = None if _C.setns(own, _NAMESPACES["uts"]) == 0 else ctypes.get_errno()
        os.close(own)
    if refused in (None, errno.EPERM):  # this kernel supports the call, but only for root
        return None
    return f"the grader cannot enter a sandbox on this kernel, Linux {os.uname().release}. It needs Linux 5.8 or later"


def enter(holder: int, *, cell: bool) -> None:
    """Move this process into all namespaces of the process that this descriptor (pidfd_open(2)) refers to.

    The pid namespace only applies to processes that are forked afterwards. The process must have only one thread. A
    process of root also leaves all supplementary groups. Afterwards, other processes of the user cannot inspect this
    process.

    In a trial, the descriptor of a cell comes from a conductor (trial/conductor.py), which may be under the control of
    a node. Therefore, if `cell` is true, the process with this descriptor must not have the user namespace of this
    process. Its namespaces may still be a trap, so do not trust any file after this call: even an import or a traceback
    can run code from these mounts.

    Raises:
        OSError: the kernel refused, or the process has exited.
    """
    if os.geteuid() == 0:
        os.setgroups([])
    flags = 0
    for name, flag in _NAMESPACES.items():
        required = cell and name != "cgroup"
        if required or Path(f"/proc/{pid_of(holder)}/ns/{name}").readlink() != Path(f"/proc/self/ns/{name}").readlink():
            flags |= flag
    if _C.setns(holder, flags) != 0:
        number = ctypes.get_errno()
        raise OSError(number, f"the kernel did not let this process enter the sandbox: {os.strerror(number)}")
    allow_inspection(allow=False)  # with other capabilities, the kernel uses the value in /proc/sys/fs/suid_dumpable


def pid_of(pidfd: int) -> int:
    """Return the process id in the pid namespace of the caller. Raises OSError if the process no longer exists."""
    about = Path(f"/proc/self/fdinfo/{pidfd}").read_text("ascii")
    pid = int(next(line.split()[1] for line in about.splitlines() if line.startswith("Pid:")))
    if pid <= 0:
        raise ProcessLookupError(pid)
    return pid


def pass_descriptors(to: socket.socket, data: bytes, descriptors: Sequence[int]) -> None:
    """Send data together with file descriptors. Any thread may call this function.

    The kernel refuses if the sockets of the user contain more descriptors than the sender may open (ETOOMANYREFS of
    unix(7)). The sockets of a cell may contain somewhat more than NODE_LIMITS.open_files, so the limit of the sender is
    raised while it sends.

    Raises:
        OSError: the kernel refused, or the socket is closed at the other end.
    """
    with _passing:
        soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        most = _MOST_IN_TRANSIT if hard == resource.RLIM_INFINITY else min(hard, _MOST_IN_TRANSIT)
        raised = soft if soft == resource.RLIM_INFINITY else max(soft, most)
        resource.setrlimit(resource.RLIMIT_NOFILE, (raised, hard))
        try:
            socket.send_fds(to, [data], descriptors)
        finally:
            resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def keep(descriptors: Iterable[int]) -> None:
    """Make these descriptors the descriptors 0, 1, 2, ..., and close all other descriptors of this process."""
    kept = [os.dup(descriptor) for descriptor in descriptors]
    for number, descriptor in enumerate(kept):
        os.dup2(descriptor, number)
    close_from(len(kept))


def confine(limits: Iterable[tuple[int, int]], *, user: int | None, call_filter: bytes = b"") -> None:
    """Give up what a process in a room or cell must not have: other user ids, capabilities, privileges and resources.

    `limits` contains pairs: a constant of the module `resource`, and a value. `user` is the user id to switch to if
    this process runs as root, or None. `call_filter` comes from system_calls.program(). With an empty filter, all
    system calls remain possible. The kernel kills this process when its parent exits.

    Raises:
        OSError: the kernel refused.
    """
    for kind, value in limits:
        resource.setrlimit(kind, (value, value))
    for capability in range(_LAST_CAPABILITY + 1):
        _C.prctl(_BOUNDING_DROP, capability, 0, 0, 0)  # fails for numbers that this kernel does not know
    _C.prctl(_AMBIENT, _AMBIENT_CLEAR, 0, 0, 0)
    if user is not None:
        os.setresgid(user, user, user)
        os.setresuid(user, user, user)
    header = struct.pack("<Ii", _CAPABILITIES_VERSION_3, 0)
    if _C.capset(header, bytes(24)) != 0 or _C.prctl(_NO_NEW_PRIVILEGES, 1, 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "the capabilities could not be given up")
    end_with_parent()  # a change of the user cancels an earlier request
    allow_inspection(allow=True)
    if call_filter:
        buffer = ctypes.create_string_buffer(call_filter, len(call_filter))
        program = struct.pack("@HP", len(call_filter) // 8, ctypes.addressof(buffer))
        if _C.prctl(_SECCOMP, _SECCOMP_FILTER, program, 0, 0) != 0:
            raise OSError(ctypes.get_errno(), "the system call filter could not be installed")


def end_with_parent() -> None:
    """Let the kernel kill this process when its parent exits."""
    _C.prctl(_PARENT_DEATH, signal.SIGKILL, 0, 0, 0)


def allow_inspection(*, allow: bool) -> None:
    """Allow or forbid other processes of the user to read the memory and the descriptors of this process."""
    _C.prctl(_DUMPABLE, int(allow), 0, 0, 0)


def sacrifice() -> None:
    """Let the kernel kill this process first if memory runs out. Before that, call `allow_inspection(allow=True)`."""
    Path("/proc/self/oom_score_adj").write_text("1000", "ascii")
