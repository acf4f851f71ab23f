"""The seccomp filter of a cell: the system calls that are forbidden in it.

The filter forbids calls that no node needs and that attackers have used to escape from sandboxes. A list of allowed
calls (instead of forbidden ones) would break with a new version of Python or Fast DDS. Namespaces, limits and mounts
are the first defence, and this filter is the second. The filter also forbids calls that allocate memory which counts
towards neither a tmpfs nor a process (memfd, System V shared memory). Finally, it forbids calls that use up the
resources of a user or of the machine, because other cells may have the same user.
"""

from __future__ import annotations

import errno
import os
import platform
import socket
from contextlib import contextmanager
from typing import TYPE_CHECKING

from grader.sandbox import bpf

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

# System call numbers for x86-64 (linux/arch/x86/entry/syscalls/syscall_64.tbl), grouped by purpose.
DENIED = {
    "other processes": {
        "ptrace": 101, "process_vm_readv": 310, "process_vm_writev": 311, "kcmp": 312, "pidfd_getfd": 438,
        "process_madvise": 440,
    },
    "namespaces and mounts": {
        "unshare": 272, "setns": 308, "mount": 165, "umount2": 166, "pivot_root": 155, "chroot": 161,
        "open_tree": 428, "move_mount": 429, "fsopen": 430, "fsconfig": 431, "fsmount": 432, "fspick": 433,
        "mount_setattr": 442, "name_to_handle_at": 303, "open_by_handle_at": 304,
    },
    "keys": {"add_key": 248, "request_key": 249, "keyctl": 250},
    "parts of the kernel with the most security holes": {
        "bpf": 321, "perf_event_open": 298, "userfaultfd": 323, "io_uring_setup": 425, "io_uring_enter": 426,
        "io_uring_register": 427, "modify_ldt": 154, "fanotify_init": 300, "vmsplice": 278, "lookup_dcookie": 212,
        "uselib": 134, "_sysctl": 156, "nfsservctl": 180,
    },
    # A user may have 128 inotify instances. All users together may have 65,536 asynchronous requests.
    "resources that one cell could use up for others": {
        "inotify_init": 253, "inotify_init1": 294, "inotify_add_watch": 254, "inotify_rm_watch": 255,
        "io_setup": 206, "io_destroy": 207, "io_getevents": 208, "io_submit": 209, "io_cancel": 210,
        "io_pgetevents": 333, "sync": 162, "syncfs": 306, "seccomp": 317,
    },
    "memory that counts towards no limit": {
        "memfd_create": 319, "memfd_secret": 447, "shmget": 29, "shmat": 30, "shmctl": 31, "semget": 64, "msgget": 68,
        "mq_open": 240,
    },
    "the machine": {
        "reboot": 169, "kexec_load": 246, "kexec_file_load": 320, "init_module": 175, "finit_module": 313,
        "delete_module": 176, "swapon": 167, "swapoff": 168, "acct": 163, "quotactl": 179, "quotactl_fd": 443,
        "syslog": 103, "settimeofday": 164, "clock_settime": 227, "clock_adjtime": 305, "adjtimex": 159,
        "sethostname": 170, "setdomainname": 171, "iopl": 172, "ioperm": 173, "vhangup": 153,
    },
}  # fmt: skip
FLUSHES = {"fsync": 74, "fdatasync": 75}
"""In a cell, these calls do nothing and succeed. The disks of a cell are in memory. If these calls were executed for a
file outside the cell, even one that is open for reading only, they would flush a disk of the host."""
_MMAP, _SOCKET, _SOCKETPAIR, _SETSOCKOPT, _CLONE, _CLONE3, FCNTL, PRCTL, PRLIMIT = 9, 41, 53, 54, 56, 435, 72, 157, 302
_OWN = 0
"""The process id with which prlimit(2) sets the limits of the calling process. Other process ids are
refused."""
_SHARED_MEMORY = 0x21
"""MAP_SHARED | MAP_ANONYMOUS of mmap(2). The combination of the two flags is forbidden.

After a process has emptied its page tables with madvise, such memory counts towards neither a tmpfs nor a process.
"""
SET_LEASE, NOTIFY, _SET_PIPE_SIZE = 1024, 1026, 1031
"""F_SETLEASE, F_NOTIFY and F_SETPIPE_SZ of fcntl(2), which are forbidden.

While a process has a lease on a file of its user, all other programs that open the file wait for 45 s. F_NOTIFY reports
the use of folders that other cells can read, too. A user may have only 64 pipes of 1 MiB. Further pipes are small.
"""
SET_SECCOMP = 22
_OF_SOCKETS = (26, 50, 51, 52, 60)
"""PR_SET_SECCOMP of prctl(2). Of socket(7): SO_ATTACH_FILTER, SO_ATTACH_BPF, SO_ATTACH_REUSEPORT_CBPF,
SO_ATTACH_REUSEPORT_EBPF and SO_ZEROCOPY.

These options are forbidden. All filters of a machine share a limit on compiled programs (bpf_jit_limit), which about
3,000 long filters use up. After that, a cell could not install the filter in this module. SO_ZEROCOPY locks memory,
which the kernel counts per user.
"""
# AF_UNIX, AF_INET, AF_INET6, and AF_NETLINK for listing interfaces. AF_VSOCK would reach the host of a virtual machine.
_NETLINK = 16
_FAMILIES = (1, 2, 10, _NETLINK)
# SOCK_STREAM, SOCK_DGRAM, SOCK_RAW (for AF_NETLINK) and SOCK_SEQPACKET, without the flags in the higher bits.
_TYPES, _TYPE_BITS = (1, 2, 3, 5), 0xF
# The family's default protocol, TCP and UDP. For others, such as SCTP, the kernel loads modules that are little tested.
# The protocols of AF_NETLINK have numbers of their own: only the default, NETLINK_ROUTE, lists interfaces.
_PROTOCOLS = (0, 6, 17)
# CLONE_NEWNS, NEWCGROUP, NEWUTS, NEWIPC, NEWUSER, NEWPID and NEWNET.
_NEW_NAMESPACE = 0x7E020000


@contextmanager
def call_filter() -> Iterator[int | None]:
    """Yield a file descriptor from which the filter can be read once, or None on processors other than x86-64."""
    if not (lines := program()):
        yield None
        return
    reads, writes = os.pipe()
    try:
        # The capacity of a pipe is much larger than the filter.
        os.write(writes, lines)
        os.close(writes)
        yield reads
    finally:
        os.close(reads)


def program() -> bytes:
    """Return the filter: a sequence of struct sock_filter, which is empty on processors other than x86-64."""
    if platform.machine() != "x86_64":
        return b""
    refuse = bpf.ERRNO | errno.EPERM
    absent = bpf.ERRNO | errno.ENOSYS
    lines = bpf.begin()
    lines += bpf.refusing(sorted(number for group in DENIED.values() for number in group.values()), errno.EPERM)
    lines += bpf.refusing(sorted(FLUSHES.values()), 0)
    # The flags of clone3 are in memory, which a filter cannot read. The C library falls back to clone.
    lines += [(bpf.EQUAL, 0, 1, _CLONE3), (bpf.RETURN, 0, 0, absent)]
    lines += [(bpf.EQUAL, 0, 4, _CLONE), (bpf.LOAD, 0, 0, bpf.argument(0))]
    lines += [(bpf.ANY_BIT, 0, 1, _NEW_NAMESPACE), (bpf.RETURN, 0, 0, refuse), (bpf.RETURN, 0, 0, bpf.ALLOW)]
    # The process that makes the calls of a submission must keep its own limits (trial/cell_calls.py).
    lines += [(bpf.EQUAL, 0, 4, PRLIMIT), (bpf.LOAD, 0, 0, bpf.argument(0)), (bpf.EQUAL, 1, 0, _OWN)]
    lines += [(bpf.RETURN, 0, 0, refuse), (bpf.RETURN, 0, 0, bpf.ALLOW)]
    lines += bpf.refusing_options(PRCTL, 0, (SET_SECCOMP,), errno.EPERM)
    lines += bpf.refusing_options(_SETSOCKOPT, 2, _OF_SOCKETS, errno.EPERM, level=socket.SOL_SOCKET)
    lines += bpf.refusing_options(FCNTL, 1, (SET_LEASE, NOTIFY, _SET_PIPE_SIZE), errno.EPERM)
    lines += [(bpf.EQUAL, 0, 5, _MMAP), (bpf.LOAD, 0, 0, bpf.argument(3)), (bpf.AND, 0, 0, _SHARED_MEMORY)]
    lines += [(bpf.EQUAL, 0, 1, _SHARED_MEMORY), (bpf.RETURN, 0, 0, refuse), (bpf.RETURN, 0, 0, bpf.ALLOW)]
    sockets = _usual_socket()
    lines += [(bpf.EQUAL, 1, 0, _SOCKET), (bpf.EQUAL, 0, len(sockets), _SOCKETPAIR), *sockets]
    lines += [(bpf.RETURN, 0, 0, bpf.ALLOW)]
    return bpf.packed(lines)


def _usual_socket() -> list[bpf.Line]:
    """Return the instructions that make socket and socketpair fail for rare kinds of sockets.

    The kernel loads the module of a family or protocol before it finds out that the call must fail.
    """
    lines = _one_of(0, _FAMILIES, errno.EAFNOSUPPORT)
    lines += _one_of(1, _TYPES, errno.ESOCKTNOSUPPORT, bits=_TYPE_BITS)
    lines += _one_of(2, _PROTOCOLS, errno.EPROTONOSUPPORT)
    of_netlink = _one_of(2, _PROTOCOLS[:1], errno.EPROTONOSUPPORT)
    return [*lines, (bpf.LOAD, 0, 0, bpf.argument(0)), (bpf.EQUAL, 0, len(of_netlink), _NETLINK), *of_netlink]


def _one_of(index: int, values: Sequence[int], error: int, *, bits: int = 0) -> list[bpf.Line]:
    """Return the instructions that make a call fail unless this argument has one of the values.

    The comparison uses only the bits of the argument that are set in `bits`, or its low 32 bits if `bits` is 0.
    """
    load = [(bpf.LOAD, 0, 0, bpf.argument(index)), *([(bpf.AND, 0, 0, bits)] if bits else [])]
    lines = [(bpf.EQUAL, len(values) - number, 0, value) for number, value in enumerate(values)]
    return [*load, *lines, (bpf.RETURN, 0, 0, bpf.ERRNO | error)]
