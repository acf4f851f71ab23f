"""A separate ROS domain for programs that do not run in a separate network."""

from __future__ import annotations

import fcntl
from typing import TYPE_CHECKING

from grader.common.private_folder import users_folder
from grader.errors import MachineError
from grader.graph.announcements import participant_ports
from grader.ros.domain import HIGHEST

if TYPE_CHECKING:
    from contextlib import ExitStack
    from pathlib import Path

_DOMAINS: tuple[int, ...] = (*range(1, 102), *range(215, HIGHEST + 1))
"""The domains whose ports are outside of the range from which Linux assigns ports to any program, 32768 to 60999. Of
domain 101, this is true for the ports of the first 54 participants."""
_ALL_IN_USE = (
    "All ROS domains whose ports Linux does not assign to other programs (1 to 101 and 215 to 232) are in use by other "
    "trials or tests: wait until one has ended."
)


def own_domain(stack: ExitStack) -> int:
    """Return a ROS domain that no other call returns to this user on this machine until `stack` is closed.

    A domain with nodes, such as a turtlesim that the user has started, is not returned.

    Raises:
        MachineError: all domains are in use, or the folder of the lock files cannot be used.
    """
    for domain in _DOMAINS:
        file = stack.enter_context(lock_file(domain).open("w"))
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            in_use = bool(participant_ports(domain))
        except BlockingIOError:
            in_use = True
        if not in_use:
            return domain
        file.close()
    raise MachineError(_ALL_IN_USE)


def lock_file(domain: int) -> Path:
    """Return the file that is locked while a program of this user has the domain for itself.

    Raises:
        MachineError: the folder of the lock files cannot be used.
    """
    return users_folder() / f"domain-{domain}.lock"
