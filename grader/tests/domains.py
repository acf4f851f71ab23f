"""ROS domains for tests. Two test processes on one machine never use the same domain, nor that of a trial."""

from __future__ import annotations

import fcntl
import time
from contextlib import contextmanager
from functools import cache
from typing import IO, TYPE_CHECKING

from grader.graph.announcements import participant_ports
from grader.tests.waiting import HANG_S
from grader.trial.own_domain import lock_file

if TYPE_CHECKING:
    from collections.abc import Iterator

FIRST, LAST = 2, 101
"""The domains that tests use. Domain 1 belongs to root, and root may be using this machine at the same time. Trials
also use higher domains, so they find a domain even if tests hold all of these."""
MOST = 3
"""The number of domains that `own_domain` keeps in addition to the default domain. When a process needs more domains
than this, it uses its least recently used domain again."""
_held: dict[int, IO[str]] = {}
_own: list[int] = []


@cache
def default_domain() -> int:
    """Return the default domain of the processes that this process starts."""
    return _reserved()


def own_domain() -> int:
    """Return the next domain of this process. After the last domain, start again with the first domain.

    For programs that end before this function has been called MOST times again; others use `separate_domain`.
    """
    default_domain()
    domain = _reserved() if len(_own) < MOST else _own.pop(0)
    _own.append(domain)
    return domain


@contextmanager
def separate_domain() -> Iterator[int]:
    """Yield a domain that is used for nothing else until the end of the context."""
    default_domain()
    domain = _reserved()
    try:
        yield domain
    finally:
        _held.pop(domain).close()


def _reserved() -> int:
    """Reserve a domain for this process, and return it. If no domain is free, wait for one."""
    deadline = time.monotonic() + HANG_S
    while (domain := _free()) is None:
        assert time.monotonic() < deadline, "all ROS domains are in use by other tests"
        time.sleep(1.0)
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
