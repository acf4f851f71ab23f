"""Linux system calls that the `os` module of some Python installations does not have.

Python has only the system calls that were declared in the C headers of the machine on which Python was built. For
example, the Python of conda is built for old systems, so it has no `os.pidfd_open`, even on a new kernel.

This module needs only the standard library.
"""

from __future__ import annotations

import fcntl
import os
import signal
import time
from contextlib import suppress
from pathlib import Path

F_OFD_SETLK: int = getattr(fcntl, "F_OFD_SETLK", 37)
"""The command of fcntl(2) that locks a part of a file for an open file description. (Value: asm-generic/fcntl.h.)"""
_PR_SET_CHILD_SUBREAPER = 36
_PR_SET_TIMERSLACK = 29
"""First arguments of prctl(2). (Values: linux/prctl.h.)"""
_PIDFD_SEND_SIGNAL, _PIDFD_OPEN, _CLOSE_RANGE = 424, 434, 436
"""The numbers of the system calls, which are the same on x86-64 and on arm64."""


def pidfd_open(pid: int) -> int:
    """Return a file descriptor that refers to a process (pidfd_open(2)).

    Raises:
        OSError: there is no such process, or the kernel is older than Linux 5.3.
    """
    if hasattr(os, "pidfd_open"):
        return os.pidfd_open(pid)
    return _call(_PIDFD_OPEN, pid, 0)  # the kernel makes it close-on-exec


def pidfd_send_signal(pidfd: int, number: int) -> None:
    """Send a signal to the process that this descriptor refers to (pidfd_send_signal(2)).

    Raises:
        OSError: the process has exited (ProcessLookupError), or the kernel refused.
    """
    if hasattr(signal, "pidfd_send_signal"):
        signal.pidfd_send_signal(pidfd, number)
    else:
        _call(_PIDFD_SEND_SIGNAL, pidfd, number, None, 0)


def limited_cpu_s(pid: int) -> float:
    """Return the CPU time (s) of a process, which may have exited, that the kernel compares with RLIMIT_CPU.

    The kernel counts this time in clock ticks. On a busy machine, the CPU time that /proc/PID/stat and wait4(2) report
    was up to 15 % lower. Processes that this process started do not count.

    Raises:
        OSError: there is no such process, not even one that nobody has waited for.
    """
    # CPUCLOCK_PROF of the process: MAKE_PROCESS_CPUCLOCK in linux/posix-timers.h.
    return time.clock_gettime(~pid << 3)


def adopt_orphans() -> None:
    """Let each orphan among the descendants of this process become a child of this process (prctl(2)).

    Otherwise, orphans usually become children of the first process of the system.
    """
    import ctypes

    ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def sleep_precisely() -> None:
    """Let this thread, and the threads that it creates, wake up on time (prctl(2)).

    By default, Linux wakes a thread up to 50 microseconds late, so that it can wake several threads at once.
    """
    import ctypes

    ctypes.CDLL(None).prctl(_PR_SET_TIMERSLACK, 1, 0, 0, 0)


def close_from(lowest: int) -> None:
    """Close all file descriptors of this process from `lowest` upwards.

    If Python was built without close_range(2), `os.closerange` calls close(2) for every number up to the limit on open
    files. This takes minutes if the limit is very high, as in some containers.
    """
    try:
        _call(_CLOSE_RANGE, lowest, 2**32 - 1, 0)
    except OSError:  # Linux before 5.9
        for number in [int(path.name) for path in Path("/proc/self/fd").iterdir()]:
            with suppress(OSError):  # the descriptor of the folder itself
                if number >= lowest:
                    os.close(number)


def _call(number: int, *arguments: int | None) -> int:
    import ctypes

    library = ctypes.CDLL(None, use_errno=True)
    result: int = library.syscall(number, *arguments)
    if result < 0:
        error = ctypes.get_errno()
        raise OSError(error, os.strerror(error))
    return result
