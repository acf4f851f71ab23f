"""Kill all descendants of a process, for programs that run without a sandbox.

A descendant may be in another process group or session, so killing the process group of the first process is not
enough. With a sandbox, the end of a cell is the end of all processes in it.
"""

from __future__ import annotations

import os
import signal
import time
from contextlib import suppress
from pathlib import Path

from grader.common.process_stat import has_exited, stat_fields
from grader.sandbox.usage import family

_MOST_S = 5.0
"""The maximum time to wait for the processes to exit (s). The kernel cannot end some processes, such as one that waits
for a disk."""
_AGAIN_S = 0.01


def kill_descendants(pid: int) -> None:
    """Kill all descendants of the process, until all of them have exited or _MOST_S has passed.

    Orphans are included if the process has called `grader.common.linux_calls.adopt_orphans`.
    """
    until = time.monotonic() + _MOST_S
    # A process may have been started while the others were being killed, and orphans get a new parent.
    while (living := [each for each in family(pid) if each != pid and _runs(each)]) and time.monotonic() < until:
        for each in living:
            with suppress(ProcessLookupError, PermissionError):
                os.kill(each, signal.SIGKILL)
        time.sleep(_AGAIN_S)


def _runs(pid: int) -> bool:
    """Return whether the process has not exited. An exited process is a zombie until its parent waits for it."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_bytes()
    except OSError:
        return False
    return not has_exited(stat_fields(stat))
