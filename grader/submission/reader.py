"""Reader: read a student's files in a child process with limits on time and memory.

All code that reads a student's files must go through `read`. The child process is a fork, so it has all data of its
parent process. The child process returns plain data. A test (grader/tests/test_reading.py) fails if other code reads a
submission.
"""

from __future__ import annotations

import errno
import gc
import io
import os
import pickle
import resource
import select
import signal
import stat
import sys
import tempfile
import time
import traceback
from contextlib import suppress
from dataclasses import is_dataclass
from enum import Enum
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, ParamSpec, TypeVar

from grader.common.lazy import IMPORTING
from grader.common.linux_calls import limited_cpu_s
from grader.common.system_errors import refusal
from grader.errors import GraderError, MachineError, TooLargeError, UnreadableError
from grader.sandbox.landlock import allow_only_reading
from grader.sandbox.limits import NO_CORE_DUMP, allowed
from grader.sandbox.own_mounts import keep_only
from grader.sandbox.reading_calls import forbid_all_but_reading
from grader.submission.program_files import paths_in, program_files

if TYPE_CHECKING:
    from collections.abc import Callable

P = ParamSpec("P")
T = TypeVar("T")
CPU_S = 10
TIMEOUT_S = 120.0
MEMORY = 1024 * 1024 * 1024
"""The maximum address space that the child may use in addition to the address space of the grader (bytes)."""
MOST_ANSWER = 256 * 1024 * 1024
"""The maximum size of a result (bytes). The result consists mostly of the files of a submission."""
_CHUNK = 1024 * 1024
_STANDARD = {
    "builtins": ("set", "frozenset", "bytearray", "complex"),
    "datetime": ("datetime",),
    "pathlib": ("PosixPath",),
    "markupsafe": ("Markup",),
    "numpy": ("_frombuffer", "_reconstruct", "dtype", "ndarray", "scalar"),
}
"""Maps a top-level module to its types and functions that a result may refer to. A result may also refer to our
dataclasses, enumerations and errors."""


class _Child:
    """Whether this process was forked by `read`. In a forked process, `read` calls the function directly."""

    inside = False


def read(function: Callable[P, T], *arguments: P.args, **keywords: P.kwargs) -> T:
    """Call the function in a child process and return its result, which may contain only what `_Unpacker` accepts.

    The function can open only `program_files` and the files and folders that are positional arguments (instances of
    Path, also in a list or tuple), if the machine has Landlock or lets this user create a mount namespace.

    Raises:
        TooLargeError: the function took too much CPU time, memory or stack, or its result is too large.
        UnreadableError: the function raised an exception other than the grader's own errors, or its process crashed.
        MachineError: a module that the function needs is not installed, or the machine was too busy or out of memory.
        GraderError: the function itself raised this error.
    """
    if _Child.inside:
        return function(*arguments, **keywords)
    readable = (*program_files(), *paths_in(arguments))
    call = partial(function, *arguments, **keywords)
    answer, status = _called(call, readable)
    if not answer and os.WTERMSIG(status) != signal.SIGXCPU:
        # Another program may have killed the child, or another thread held a lock that the child needed.
        answer, status = _called(call, readable)
    return _value(answer, status)  # type: ignore[no-any-return]


def _called(function: Callable[[], object], readable: tuple[Path, ...]) -> tuple[bytes | None, int]:
    """Call the function in a child process. Return the child's data, or None after the timeout, and its exit status."""
    receives, sends = os.pipe()
    child = _fork()
    if child == 0:
        _run(sends, readable, function)
    os.close(sends)
    status = None
    try:
        answer = _received(receives)
        if answer is not None:
            status = _ended(child)
    finally:
        os.close(receives)
        if status is None:
            os.kill(child, signal.SIGKILL)
            status = _ended(child)
    return answer, status


def is_confined() -> bool:
    """Return whether a child process of `read` can open only the files that `read` allows."""
    with tempfile.NamedTemporaryFile() as file:
        return not read(_can_open, file.name)


def _can_open(path: str) -> bool:
    try:
        Path(path).open("rb").close()
    except OSError:
        return False
    return True


def _fork() -> int:
    try:
        # The child must not need a lock that another thread holds. It only reads, computes, and writes to its pipe, but
        # it may import numpy, which another thread may be importing now.
        with IMPORTING:
            return os.fork()
    except OSError as error:
        raise MachineError(refusal(error) or str(error)) from error


def _ended(child: int) -> int:
    """Return the exit status of the child. If the child ignored SIGXCPU and was killed later, it is SIGXCPU, too."""
    try:
        os.waitid(os.P_PID, child, os.WEXITED | os.WNOWAIT)
        is_late = limited_cpu_s(child) >= CPU_S
        status = os.waitpid(child, 0)[1]
    except ChildProcessError:
        return 0  # SIGCHLD is ignored, as in our parent process, so the exit status is unknown
    return int(signal.SIGXCPU) if is_late and os.WTERMSIG(status) == signal.SIGKILL else status


def _run(sends: int, readable: tuple[Path, ...], function: Callable[[], object]) -> NoReturn:
    """Run the function in the child, and exit."""
    try:
        _Child.inside = True
        gc.disable()  # garbage collection would write to, and therefore copy, all memory of the parent
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)
        _close_all_but(sends)
        _limit()
        if not allow_only_reading(readable):
            keep_only(readable)
        forbid_all_but_reading()
        sys.addaudithook(_refuse_pipes)
        with open(sends, "wb") as pipe:
            pipe.write(_answer(function))
    except BaseException:
        os._exit(1)
    os._exit(0)


def _refuse_pipes(event: str, arguments: tuple[Any, ...]) -> None:
    """Raise OSError if a named pipe is about to be opened, because opening a pipe without a writer would block."""
    if event != "open" or not isinstance(arguments[0], str | bytes) or (arguments[2] or 0) & os.O_NONBLOCK:
        return
    try:
        mode = os.stat(arguments[0]).st_mode  # noqa: PTH116 - bytes are possible
    except (OSError, ValueError):
        return  # opening the file fails, too
    if stat.S_ISFIFO(mode):
        raise OSError(errno.ENXIO, "it is a named pipe, not a file")


def _close_all_but(sends: int) -> None:
    """Close the child's copies of the parent's descriptors: a copy would keep a pipe open that the parent has closed.

    The terminal is closed as well (except stderr with GRADER_DEBUG). If the child had access to the terminal, it could
    type commands in place of the user.
    """
    empty = os.open(os.devnull, os.O_RDWR)
    for number in range(2 if os.environ.get("GRADER_DEBUG") else 3):
        os.dup2(empty, number)
    for number in [int(entry.name) for entry in Path("/proc/self/fd").iterdir()]:
        if number > 2 and number != sends:
            with suppress(OSError):  # the descriptor that was used for listing the folder
                os.close(number)


def _limit() -> None:
    mapped = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    for which, most in (
        (resource.RLIMIT_AS, mapped + MEMORY),
        (resource.RLIMIT_CPU, CPU_S),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_CORE, NO_CORE_DUMP),
    ):
        # A second after SIGXCPU, at the hard limit, the kernel sends SIGKILL.
        resource.setrlimit(which, (allowed(which, most), allowed(which, most + 1)))


def _answer(function: Callable[[], object]) -> bytes:
    try:
        return _packed(fine=True, value=function())
    except MemoryError:
        raised: Exception = TooLargeError(_too_much())
    except RecursionError:
        raised = TooLargeError("it is nested too deeply to be read")
    except GraderError as error:
        raised = error
    except ModuleNotFoundError as error:
        # The child imports only the grader's modules and libraries, so the installation is incomplete.
        raised = MachineError(f"{error.name} is not installed: run `make demo` in the course's folder.")
    except Exception as error:
        if os.environ.get("GRADER_DEBUG"):
            traceback.print_exc()
        raised = UnreadableError(f"it could not be read ({type(error).__name__}: {error})"[:500])
    return _packed(fine=False, value=raised)


def _packed(*, fine: bool, value: object) -> bytes:
    packed = io.BytesIO()
    try:
        _Packer(packed, pickle.HIGHEST_PROTOCOL).dump((fine, value))
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        message = f"the result cannot be sent: {error}"
        raise MachineError(message) from error
    return packed.getvalue()


def _received(pipe: int) -> bytes | None:
    """Return everything that the child process sends, or None after the timeout. Raises TooLargeError if too large."""
    poll = select.poll()
    poll.register(pipe, select.POLLIN)
    until = time.monotonic() + TIMEOUT_S
    answer = bytearray()
    while len(answer) <= MOST_ANSWER:
        left_s = until - time.monotonic()
        if left_s <= 0 or not poll.poll(1000 * left_s):
            return None
        data = os.read(pipe, _CHUNK)
        if not data:
            return bytes(answer)
        answer += data
    raise TooLargeError(_too_much())


def _value(answer: bytes | None, status: int) -> Any:  # noqa: ANN401 - any result
    if answer is None:  # a function that computes for so long exceeds its CPU time first
        message = f"the submission could not be read within {TIMEOUT_S:g} s, because the machine was too busy"
        raise MachineError(message)
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        if number in (signal.SIGXCPU, signal.SIGKILL):
            raise TooLargeError(_too_much())
        message = f"it could not be read: the reading process was stopped by {signal.Signals(number).name}"
        raise UnreadableError(message)
    if os.WEXITSTATUS(status) != 0 or not answer:
        raise TooLargeError(_too_much())  # not even the error message fitted into memory
    try:
        fine, value = _Unpacker(io.BytesIO(answer)).load()
    except Exception as error:
        message = f"The result of the reading process is invalid: {error}. Please report it."
        raise MachineError(message) from error
    if not fine:
        raise value
    return value


def _too_much() -> str:
    return f"it is too large to be read within {CPU_S} s and {MEMORY // 1024**3} GiB of memory"


class _Packer(pickle.Pickler):
    """Pickles enumeration members and our errors as calls to their classes, even if other reducers are registered."""

    def reducer_override(self, obj: object) -> Any:  # noqa: ANN401 - as the base class
        """Return the function call that recreates the object, or NotImplemented to pickle the object as usual."""
        if isinstance(obj, Enum):
            return type(obj), (obj.value,)
        return (type(obj), obj.args) if isinstance(obj, GraderError) else NotImplemented


class _Unpacker(pickle.Unpickler):
    """Accepts only _STANDARD and our dataclasses, enumerations and errors: the child has read untrusted files."""

    def find_class(self, module: str, name: str) -> Any:  # noqa: ANN401 - a class
        """Return the class or function with this name if it is allowed."""
        if name in _STANDARD.get(module.partition(".")[0], ()):
            return super().find_class(module, name)
        found = getattr(import_module(module), name, None) if module.startswith("grader.") else None
        if isinstance(found, type) and (is_dataclass(found) or issubclass(found, Enum | GraderError)):
            return found
        message = f"{module}.{name} is not allowed"
        raise pickle.UnpicklingError(message)
