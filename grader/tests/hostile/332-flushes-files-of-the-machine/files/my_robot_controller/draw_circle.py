"""The node flushes files of the machine that it can only read."""

import ctypes
import errno
import os

QUOTACTL_FD, Q_SYNC = 443, 0x80000100


def main():
    libc = ctypes.CDLL(None, use_errno=True)
    machine = os.open("/usr", os.O_RDONLY)
    flushed = [name for name in ("fsync", "fdatasync") if getattr(libc, name)(machine) != 0]
    # The kernel refuses a descriptor that does not exist if the call reaches the kernel.
    reached = [name for name in ("fsync", "fdatasync") if getattr(libc, name)(-1) != 0]
    if libc.syscall(QUOTACTL_FD, machine, Q_SYNC, 0, None) == 0 or ctypes.get_errno() != errno.EPERM:
        reached.append("quotactl_fd")
    print("TRA" "CE" if reached else "nothing is flushed", reached, flushed)
