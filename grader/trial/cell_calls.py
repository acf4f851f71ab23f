"""Call a student's function or run a student's program, once per input, in a new process each time.

This file runs as a separate script. The script reads one line of JSON (`calls`, `script`, `function`, `python_path`,
`env`, `install`, `files`, `ahead`) and then the install tree, a tar stream, from standard input. The script writes the
line "ready", and then one line of JSON for each call that it makes. In a cell, a call cannot write such lines itself.
This process is not dumpable, so its child processes cannot open its standard output. It is also the first process of
the cell, so no other process has this standard output. All processes that a call has started are killed before the next
call, because they could change its result (without a cell, only those in the call's process group).
"""

from __future__ import annotations

import base64
import ctypes
import importlib
import json
import os
import resource
import signal
import sys
import tarfile
import tempfile
import time
import traceback
import types
from contextlib import suppress
from pathlib import Path
from typing import Any

FUNCTION_CPU_S = 2
"""The maximum CPU time of one call to a function (s). Fitting a circle in plain Python takes much less.

Unlike wall time, CPU time does not depend on the load of the machine.
"""
PROGRAM_CPU_S = 5
"""The maximum CPU time of one run of a program (s), which also imports modules and reads a bag."""
CALL_S = 20.0
"""The maximum wall time of one call (s), without the time for which the call waits for a processor. After a call that
exceeds one of the limits, no further call is made."""
MOST_TEXT = 20_000
POLL_S = 0.005
TOO_LATE = "too late"
_DUMPABLE = 4
"""PR_SET_DUMPABLE of prctl(2)."""


def main() -> None:
    """Read a list of calls from standard input, and make these calls."""
    os.write(1, b"ready\n")
    order = json.loads(sys.stdin.buffer.readline())
    with tarfile.open(fileobj=sys.stdin.buffer, mode="r|") as tree:
        # A malicious member can do no harm in a cell, and the Python of Debian 12 does not have extraction filters yet.
        tree.extraction_filter = lambda member, _path: member
        tree.extractall(order["install"])
    for path, data in order["files"].items():
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        Path(path).write_bytes(base64.b64decode(data))
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.environ.update(order["env"])
    # The package can contain a module of any name. Only the processes of the calls import modules of the package.
    sys.path[:] = [folder for folder in sys.path if folder not in order["python_path"]]
    for module in order["ahead"]:
        importlib.import_module(module)
    ctypes.CDLL(None).prctl(_DUMPABLE, 0, 0, 0, 0)
    for call in order["calls"]:
        called = _called(order, call)
        os.write(1, json.dumps({"id": call["id"], **called}).encode() + b"\n")
        if called["ended"] == TOO_LATE:
            break


def _called(order: dict[str, Any], call: dict[str, Any]) -> dict[str, Any]:
    """Make one call in a child process, and return its result."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err, tempfile.TemporaryFile() as returned:
        child = os.fork()
        if child == 0:
            _child(order, call, (out.fileno(), err.fileno(), returned.fileno()))
        ended = _ended(child, _cpu_limits(order)[0])
        _end_processes(child)
        values, kind = _returned(_text(returned.fileno()))
        return {
            "ended": ended,
            "stdout": _text(out.fileno()),
            "stderr": _text(err.fileno()),
            "values": values,
            "kind": kind,
        }


def _text(file: int) -> str:
    """Return the text of the file, or its beginning and end if the text is long."""
    size = os.fstat(file).st_size
    if size <= MOST_TEXT:
        return os.pread(file, MOST_TEXT, 0).decode("utf-8", "replace")
    half = MOST_TEXT // 2
    return (os.pread(file, half, 0) + b"\n...\n" + os.pread(file, half, size - half)).decode("utf-8", "replace")


def _returned(text: str) -> tuple[list[float] | None, str]:
    try:
        values, kind = json.loads(text)
    except (ValueError, TypeError, RecursionError):  # the call can write anything
        return None, ""
    return values, kind


def _cpu_limits(order: dict[str, Any]) -> tuple[int, int]:
    """Return the soft and the hard limit on the CPU time of one call (s)."""
    cpu_s = FUNCTION_CPU_S if order["function"] else PROGRAM_CPU_S
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    most_s = cpu_s + 1 if hard == resource.RLIM_INFINITY else min(cpu_s + 1, hard)
    return min(cpu_s, most_s), most_s


def _ended(child: int, most_cpu_s: int) -> str:
    """Wait until the call has ended, and return how it ended.

    A call can ignore SIGXCPU, or end normally when this signal arrives. Therefore, its CPU time counts, too.
    """
    until = time.monotonic() + CALL_S
    while time.monotonic() < until or time.monotonic() < until + _waited_s(child):
        if os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None:
            is_late = _cpu_s(child) >= most_cpu_s
            code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
            if is_late or code == -signal.SIGXCPU:
                return TOO_LATE
            return f"exit {code}" if code >= 0 else f"signal {-code}"
        time.sleep(POLL_S)
    os.kill(child, signal.SIGKILL)  # the child may have left its process group
    os.waitpid(child, 0)
    return TOO_LATE


def _cpu_s(process: int) -> float:
    """Return the CPU time of a process (s) that the kernel compares with RLIMIT_CPU. See grader.common.linux_calls."""
    return time.clock_gettime(~process << 3)


def _waited_s(process: int) -> float:
    """Return for how long the first thread of a process has waited for a processor (s). See grader.sandbox.usage."""
    try:
        return int(Path(f"/proc/{process}/schedstat").read_text("ascii").split()[1]) / 1e9
    except (OSError, IndexError, ValueError):  # not every kernel counts this
        return 0.0


def _end_processes(child: int) -> None:
    """Kill all processes that a call has started. Without a cell, kill only the process group of the call."""
    with suppress(ProcessLookupError):
        if os.getpid() == 1:
            os.kill(-1, signal.SIGKILL)  # all processes of the cell, except this one
        else:
            os.killpg(child, signal.SIGKILL)
    with suppress(ChildProcessError):
        while os.getpid() == 1:
            os.wait()


def _child(order: dict[str, Any], call: dict[str, Any], files: tuple[int, int, int]) -> None:
    os.setpgid(0, 0)
    ctypes.CDLL(None).prctl(_DUMPABLE, 1, 0, 0, 0)  # so that a program can open /dev/stdin and /dev/stdout
    resource.setrlimit(resource.RLIMIT_CPU, _cpu_limits(order))
    os.dup2(files[0], 1)
    os.dup2(files[1], 2)
    sys.path[:0] = order["python_path"]
    importlib.invalidate_caches()
    code = 1
    try:
        if order["function"]:
            _call_function(order["function"], call, files[2])
        else:
            _run_program(Path(order["script"]), call["arguments"])
        code = 0
    except SystemExit as error:
        code = error.code if isinstance(error.code, int) else int(error.code is not None)
        if error.code is not None and not isinstance(error.code, int):
            print(error.code, file=sys.stderr)
        if order["function"]:
            code = code or 1  # a function must not end the program
    except BaseException as error:
        trace = error.__traceback__
        while trace is not None and trace.tb_frame.f_code.co_filename == "<string>":
            trace = trace.tb_next
        traceback.print_exception(type(error), error, trace)
        os.write(files[2], json.dumps([None, " ".join(each.__name__ for each in type(error).__mro__)]).encode())
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code & 0xFF)


def _call_function(name: str, call: dict[str, Any], file: int) -> None:
    module, _, attribute = name.partition(":")
    function = getattr(importlib.import_module(module), attribute)
    x, y = call["x"], call["y"]
    if not call["lists"]:
        numpy = importlib.import_module("numpy")
        x, y = numpy.array(x, dtype=float), numpy.array(y, dtype=float)
    answer = function(x, y)
    try:
        values = [float(each) for each in answer]
    except (TypeError, ValueError):
        values = None
    text = json.dumps([values if values is None or len(values) <= 10 else None, type(answer).__name__])
    os.write(file, text.encode())


def _run_program(script: Path, arguments: list[str]) -> None:
    sys.path.insert(0, str(script.parent))
    sys.argv = [str(script), *arguments]
    module = types.ModuleType("__main__")
    module.__file__ = str(script)
    sys.modules["__main__"] = module
    exec(compile(script.read_bytes(), str(script), "exec"), module.__dict__)


if __name__ == "__main__":
    main()
