"""ROS domains for tests. Two test processes on one machine never use the same domain, nor that of a trial."""

from __future__ import annotations

import fcntl
import time
from functools import cache
from typing import IO

from grader.graph.announcements import participant_ports
from grader.tests.waiting import HANG_S
from grader.trial.own_domain import lock_file

FIRST, LAST = 2, 101
"""The domains that tests use. Domain 1 belongs to root, and root may be using this machine at the same time. Domains
above 101 use ports that Linux may assign to any program."""
MOST = 8
"""The number of domains that a process keeps in addition to its default domain. When a process needs more domains than
this, it uses its least recently used domain again."""
_held: dict[int, IO[str]] = {}
_own: list[int] = []


@cache
def default_domain() -> int:
    """Return the default domain of the processes that this process starts."""
    deadline = time.monotonic() + HANG_S
    while (domain := _free()) is None:
        assert time.monotonic() < deadline, "all ROS domains are in use by other tests"
        time.sleep(1.0)
    return domain


def own_domain() -> int:
    """Return the next domain of this process. After the last domain, start again with the first domain."""
    default_domain()
    domain = _free() if len(_own) < MOST else None
    if domain is None:
        # No domain is free. The default domain is better than the domain of another process.
        domain = _own.pop(0) if _own else default_domain()
    _own.append(domain)
    return domain


def _free() -> int | None:
    """Reserve a domain for this process until it ends, and return it. Return None if no domain is free.

    A domain is not free if a process uses it, for example a process of a test that was killed.
    """
    for domain in range(FIRST, LAST + 1):
        if domain in _held:
            continue
        file = lock_file(domain).open("w")  # trials without a sandbox use the same files
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            in_use = bool(participant_ports(domain))
        except BlockingIOError:
            in_use = True
        if in_use:
            file.close()
            continue
        _held[domain] = file
        return domain
    return None
