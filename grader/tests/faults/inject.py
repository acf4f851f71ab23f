"""Run a command of the grader in which one kind of system call fails, starting with a given function."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.tests.both_worlds import python_path

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

ARMED = """
import ctypes, importlib, os

place, name = os.environ["FAULT_FROM"].split(":")
module = importlib.import_module(place)
real = getattr(module, name)


def armed(*arguments, **options):
    ctypes.CDLL(os.environ["LD_PRELOAD"]).fault_arm()
    return real(*arguments, **options)


setattr(module, name, armed)
seen = os.environ.pop("FAULT_IN_ROOMS", None)
if seen:
    from pathlib import Path

    from grader.trial import conductor_process, fork_client

    clean, view = fork_client.interpreter, conductor_process.bubblewrap.ros_view
    faults = {name: value for name, value in os.environ.items() if name.startswith(("FAULT", "LD_PRELOAD"))}

    def interpreter(*arguments, env, **options):
        # In a learner's check, conductors are forks of the server for nodes. A node never calls what arms the fault.
        return clean(*arguments, env={**env, **faults, "PYTHONPATH": seen + os.pathsep + env["PYTHONPATH"]}, **options)

    fork_client.interpreter = interpreter
    conductor_process.bubblewrap.ros_view = lambda ros, *more: view(ros, Path(seen), *more)
"""
CALLS = {
    "open": (errno.EMFILE, errno.ENOMEM, errno.EPERM),
    "write": (errno.ENOSPC,),
    "pipe": (errno.EMFILE, errno.ENFILE),
    "mkdir": (errno.ENOSPC, errno.EPERM),
    "rename": (errno.ENOSPC, errno.EPERM),
    "fork": (errno.EAGAIN, errno.ENOMEM),
    "thread": (errno.EAGAIN,),
    "memfd": (errno.EMFILE, errno.ENOMEM),
    "flock": (errno.EPERM, errno.ENOMEM),
    "epoll": (errno.EMFILE, errno.ENOMEM),
    "socket": (errno.EMFILE, errno.ENOMEM),
}
ALL = [(call, number, nth) for call, numbers in CALLS.items() for number in numbers for nth in (1, 2, 4, 9, 30)]
TRACES = ("Traceback", "Exception in thread", "Exception ignored", "Fatal Python error", "terminate called")
LIMIT_S = 300


@dataclass(frozen=True)
class Fault:
    """A kind of system call that fails with an errno, from the `nth` call after "module:name" has started."""

    call: str
    number: int
    nth: int
    since: str
    in_rooms: bool = False
    """Whether the conductor is the process that calls the function."""


@dataclass(frozen=True)
class Done:
    """The output of a command, its exit code, and the number of calls that failed."""

    code: int
    said: str
    failures: int


def environment(folder: Path, shim: Path, fault: Fault) -> dict[str, str]:
    """Return the variables that inject the fault into a command. The injection stores its files in `folder`."""
    observed = folder / "seen"  # the folder is visible in the rooms, too
    observed.mkdir(exist_ok=True)
    (observed / "sitecustomize.py").write_text(ARMED)
    preloaded = shutil.copy(shim, observed)
    faults = {
        "PYTHONPATH": python_path(observed),
        "LD_PRELOAD": str(preloaded),
        "FAULT_LOG": str(folder / "failures"),
        "FAULT_FROM": fault.since,
        "FAULT": f"{fault.call} {fault.number} {fault.nth}",
    }
    return {**os.environ, **faults, **({"FAULT_IN_ROOMS": str(observed)} if fault.in_rooms else {})}


def run(
    command: Sequence[str], folder: Path, shim: Path, fault: Fault, settings: Mapping[str, str] | None = None
) -> Done:
    """Run a command of the grader with this fault."""
    program = str(Path(sys.prefix, "bin", command[0]))
    env = {**environment(folder, shim, fault), **(settings or {})}
    done = subprocess.run(
        [program, *command[1:]],
        cwd=folder, env=env, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
        timeout=LIMIT_S, check=False,
    )  # fmt: skip
    return Done(done.returncode, done.stdout + done.stderr, failures(folder))


def failures(folder: Path) -> int:
    """Return the number of calls that have failed so far."""
    log = folder / "failures"
    return len(log.read_text("utf-8").splitlines()) if log.exists() else 0


def no_traceback(done: Done) -> None:
    """Check that the output has no traceback and reports no fault of the grader."""
    for trace in (*TRACES, "GRADER_DEBUG=1"):
        assert trace not in done.said, done.said
