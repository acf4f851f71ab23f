"""The resource limits of this user that affect a trial: open files, processes, memory, and the size of pipes."""

from __future__ import annotations

import os
import resource

from grader.errors import MachineError
from grader.sandbox.limits import LEAST_MEMORY, MIB, RAISE_MEMORY, RAISE_PROCESSES, require_memory
from grader.trial.node_process import PIPE, enlarge
from grader.trial.open_files import LEAST as LEAST_FILES

LEAST_PROCESSES = 1024


def shares() -> tuple[str, str]:
    """Return the limits, and the command that raises them (an empty string if they are high enough for grading)."""
    files, processes = (resource.getrlimit(which)[0] for which in (resource.RLIMIT_NOFILE, resource.RLIMIT_NPROC))
    reads, writes = os.pipe()
    try:
        large = enlarge(reads) >= PIPE
    finally:
        os.close(reads)
        os.close(writes)
    unlimited = processes == resource.RLIM_INFINITY
    observed = f"{files} open files, {'any number of' if unlimited else processes} processes"
    if files < LEAST_FILES:
        return observed, f"ulimit -n {4 * LEAST_FILES}"
    if not unlimited and processes < LEAST_PROCESSES:
        return observed, RAISE_PROCESSES
    try:
        require_memory()
    except MachineError:
        return f"{observed}, less than {LEAST_MEMORY // MIB} MiB of address space for each program", RAISE_MEMORY
    return observed if large else f"{observed}; pipes stay small while other programs use many pipes", ""
