"""Wait for an event that a test has caused. If the event does not happen before a deadline, the test fails."""

from __future__ import annotations

import os
import select
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

HANG_S = 180.0
_POLL_S = 0.05


def until(there: Callable[[], bool]) -> None:
    """Wait until the condition is true."""
    deadline = time.monotonic() + HANG_S
    while not there():
        assert time.monotonic() < deadline
        time.sleep(_POLL_S)


def until_gone(pid: int) -> None:
    """Wait until a process that is not a child of this process has ended."""
    try:
        descriptor = os.pidfd_open(pid)
    except ProcessLookupError:
        return
    try:
        assert select.select([descriptor], [], [], HANG_S)[0], f"process {pid} is still there"
    finally:
        os.close(descriptor)
