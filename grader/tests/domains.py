"""ROS domains for tests: up to six processes that test on one machine at the same time never share one."""

from __future__ import annotations

import fcntl
import itertools
import os
import tempfile
from functools import cache
from pathlib import Path
from typing import IO

FIRST = 2
"""Domain 1 is root's own, where the machine's user may be at work."""
BLOCKS, EACH = 6, 16
"""Up to domain 97: above 101 a domain's ports would lie among those that Linux gives to anybody."""
_numbers = itertools.count()
_held: list[IO[str]] = []


def default_domain() -> int:
    """The domain of what this process starts without giving it one."""
    return FIRST + _block() * EACH


def own_domain() -> int:
    """Another domain of this process's block each time; after the last of them, the first again."""
    return default_domain() + 1 + next(_numbers) % (EACH - 1)


@cache
def _block() -> int:
    """A block that is this process's until it ends; shared where more than BLOCKS processes test."""
    for number in range(BLOCKS):
        file = (Path(tempfile.gettempdir()) / f"grader-test-domains-{os.getuid()}-{number}.lock").open("w")
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            file.close()
            continue
        _held.append(file)
        return number
    return os.getpid() % BLOCKS
