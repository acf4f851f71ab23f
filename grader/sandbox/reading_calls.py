"""The seccomp filter of submission/reader.py, the process that reads students' files.

The process reads, computes, and writes its result to a pipe that is already open. The process is not allowed to start a
program or a process, open a connection, change a file or a limit, or send a signal, even if a parser has a security
hole.
"""

from __future__ import annotations

import ctypes
import errno
import os
import platform

from grader.sandbox import bpf
from grader.sandbox.system_calls import DENIED, FCNTL, FLUSHES, NOTIFY, PRCTL, SET_LEASE, SET_SECCOMP

# System call numbers for x86-64, as in system_calls.py.
FORBIDDEN = {
    "programs and processes": {
        "execve": 59, "execveat": 322, "fork": 57, "vfork": 58, "setsid": 112, "setpgid": 109, "setrlimit": 160,
    },
    "connections": {"socket": 41, "socketpair": 53, "connect": 42, "accept": 43, "accept4": 288, "bind": 49},
    "signals": {
        "kill": 62, "tkill": 200, "tgkill": 234, "rt_sigqueueinfo": 129, "rt_tgsigqueueinfo": 297,
        "pidfd_open": 434, "pidfd_send_signal": 424,
    },
    "locks": {"flock": 73},
    "flushes of disks": FLUSHES,
    "the share of the processors": {
        "setpriority": 141, "ioprio_set": 251, "sched_setparam": 142, "sched_setscheduler": 144, "sched_setattr": 314,
    },
    "changes of files": {
        "creat": 85, "truncate": 76, "rename": 82, "renameat": 264, "renameat2": 316, "link": 86, "linkat": 265,
        "symlink": 88, "symlinkat": 266, "unlink": 87, "unlinkat": 263, "mkdir": 83, "mkdirat": 258, "rmdir": 84,
        "mknod": 133, "mknodat": 259, "chmod": 90, "fchmod": 91, "fchmodat": 268, "fchmodat2": 452, "chown": 92,
        "fchown": 93, "lchown": 94, "fchownat": 260, "utime": 132, "utimes": 235, "futimesat": 261, "utimensat": 280,
        "setxattr": 188, "lsetxattr": 189, "fsetxattr": 190, "removexattr": 197, "lremovexattr": 198,
        "fremovexattr": 199,
    },
}  # fmt: skip
_OPEN, _OPENAT, _OPENAT2, _CLONE, _CLONE3, _PRLIMIT, _IOCTL = 2, 257, 437, 56, 435, 302, 16
_CLONE_THREAD = 0x10000
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC
_SET_NO_NEW_PRIVILEGES, _SET_SECCOMP, _FILTER = 38, 22, 2


class _Program(ctypes.Structure):
    _fields_ = (("length", ctypes.c_ushort), ("lines", ctypes.c_char_p))


def forbid_all_but_reading() -> bool:
    """Install the filter in this process permanently. Return False if this machine does not support the filter."""
    if platform.machine() != "x86_64":
        return False
    filter_ = program()
    c = ctypes.CDLL(None)
    if c.prctl(_SET_NO_NEW_PRIVILEGES, 1, 0, 0, 0) != 0:
        return False
    whole = _Program(len(filter_) // 8, filter_)
    return bool(c.prctl(_SET_SECCOMP, _FILTER, ctypes.byref(whole), 0, 0) == 0)


def program() -> bytes:
    """Return the filter in the binary format of the kernel."""
    refuse, denied = bpf.ERRNO | errno.EPERM, bpf.ERRNO | errno.EACCES
    numbers = sorted(number for group in (*DENIED.values(), *FORBIDDEN.values()) for number in group.values())
    lines = [*bpf.begin(), *bpf.refusing(numbers, errno.EPERM)]
    # The arguments of these two calls are in memory, which a filter cannot read. The C library then uses older calls.
    lines += bpf.refusing((_CLONE3, _OPENAT2), errno.ENOSYS)
    # On a file that is open for reading only, ioctl can make it immutable, or type commands into a terminal.
    lines += bpf.refusing((_IOCTL,), errno.ENOTTY)
    # A lease on a file of this user makes all other programs that open the file wait.
    lines += bpf.refusing_options(FCNTL, 1, (SET_LEASE, NOTIFY), errno.EPERM)
    # The filters of all processes share a limit of the machine.
    lines += bpf.refusing_options(PRCTL, 0, (SET_SECCOMP,), errno.EPERM)
    for number, flags in ((_OPEN, 1), (_OPENAT, 2)):
        lines += _only_without(number, flags, _WRITING, denied)
    # Threads are allowed, since they belong to this process and share its limits.
    lines += [(bpf.EQUAL, 0, 4, _CLONE), (bpf.LOAD, 0, 0, bpf.argument(0))]
    lines += [(bpf.ANY_BIT, 1, 0, _CLONE_THREAD), (bpf.RETURN, 0, 0, refuse), (bpf.RETURN, 0, 0, bpf.ALLOW)]
    # prlimit is allowed only without a new limit, to read the current one.
    lines += [(bpf.EQUAL, 0, 6, _PRLIMIT), (bpf.LOAD, 0, 0, bpf.argument(2)), (bpf.EQUAL, 0, 3, 0)]
    lines += [(bpf.LOAD, 0, 0, bpf.argument(2, high=True)), (bpf.EQUAL, 0, 1, 0), (bpf.RETURN, 0, 0, bpf.ALLOW)]
    lines += [(bpf.RETURN, 0, 0, refuse), (bpf.RETURN, 0, 0, bpf.ALLOW)]
    return bpf.packed(lines)


def _only_without(number: int, index: int, bits: int, error: int) -> list[bpf.Line]:
    """Return the instructions that refuse the system call if its argument has any of these bits set."""
    return [
        (bpf.EQUAL, 0, 4, number),
        (bpf.LOAD, 0, 0, bpf.argument(index)),
        (bpf.ANY_BIT, 0, 1, bits),
        (bpf.RETURN, 0, 0, error),
        (bpf.RETURN, 0, 0, bpf.ALLOW),
    ]
