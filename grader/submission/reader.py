"""Reader: what a student wrote is read in a child process with limits, so that it can take neither time nor memory.

`read` is the only door. The child is a fork: it has everything that its parent has, and hands back plain data. A test
(grader/tests/test_reading.py) finds whatever reads a submission anywhere else.
"""

from __future__ import annotations

import gc
import io
import os
import pickle
import resource
import select
import signal
import time
import traceback
from contextlib import suppress
from dataclasses import is_dataclass
from enum import Enum
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, ParamSpec, TypeVar

from grader.common.refusal import refusal
from grader.errors import GraderError, MachineError, TooLargeError, UnreadableError

if TYPE_CHECKING:
    from collections.abc import Callable

P = ParamSpec("P")
T = TypeVar("T")

CPU_S = 10
TIMEOUT_S = 120.0
MEMORY = 1024 * 1024 * 1024
"""Bytes of address space beyond what the grader has itself."""
MOST_ANSWER = 256 * 1024 * 1024
"""Bytes that come back: the files of a submission are most of them."""
_CHUNK = 1024 * 1024
_STANDARD = {
    "builtins": ("set", "frozenset", "bytearray", "complex"),
    "pathlib": ("PosixPath",),
    "markupsafe": ("Markup",),
    "numpy": ("_frombuffer", "_reconstruct", "dtype", "ndarray", "scalar"),
}
"""What comes back beside dataclasses and errors of ours: the names, by the package that they are from."""


class _Child:
    """Whether this process is such a child: what reads within reads on."""

    inside = False


def read(function: Callable[P, T], *arguments: P.args, **keywords: P.kwargs) -> T:
    """What the function returns, called in a child; dataclasses of ours and what Python is made of can come back.

    Raises:
        TooLargeError: it took more time or memory than reading a submission may.
        UnreadableError: it raised something that is no error of ours.
        GraderError: what it raised.
    """
    if _Child.inside:
        return function(*arguments, **keywords)
    receives, sends = os.pipe()
    child = _fork()
    if child == 0:
        _run(sends, lambda: function(*arguments, **keywords))
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
            _ended(child)
    return _value(answer, status)  # type: ignore[no-any-return]


def _fork() -> int:
    try:
        # The child takes no lock that another thread may hold: it reads, computes, and writes into its pipe.
        return os.fork()
    except OSError as error:
        message = refusal(error) or str(error)
        raise MachineError(message) from error


def _ended(child: int) -> int:
    try:
        return os.waitpid(child, 0)[1]
    except ChildProcessError:
        return 0  # whoever started us has SIGCHLD ignored: nobody knows


def _run(sends: int, function: Callable[[], object]) -> NoReturn:
    """Be the child."""
    try:
        _Child.inside = True
        gc.disable()  # it would touch, and so copy, all that the parent has
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)
        _close_all_but(sends)
        _limit()
        with open(sends, "wb") as pipe:
            pipe.write(_answer(function))
    except BaseException:
        os._exit(1)
    os._exit(0)


def _close_all_but(sends: int) -> None:
    """Close what the parent has open: nothing is read from it, and a pipe must not stay open for longer than there."""
    for number in [int(entry.name) for entry in Path("/proc/self/fd").iterdir()]:
        if number > 2 and number != sends:
            with suppress(OSError):  # the descriptor that listed them
                os.close(number)


def _limit() -> None:
    mapped = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    for which, most in (
        (resource.RLIMIT_AS, mapped + MEMORY),
        (resource.RLIMIT_CPU, CPU_S),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_CORE, 0),
    ):
        hard = resource.getrlimit(which)[1]
        resource.setrlimit(which, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))


def _answer(function: Callable[[], object]) -> bytes:
    try:
        return _packed(fine=True, value=function())
    except MemoryError:
        raised: Exception = TooLargeError(_too_much())
    except RecursionError:
        raised = TooLargeError("it is nested too deeply to be read")
    except GraderError as error:
        raised = error
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
        message = f"what was read cannot be handed over: {error}"
        raise MachineError(message) from error
    return packed.getvalue()


def _received(pipe: int) -> bytes | None:
    """All that the child sends; None where that is too late or too much."""
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
    return None


def _value(answer: bytes | None, status: int | None) -> Any:  # noqa: ANN401 - whatever was read
    if answer is None or status is None:
        raise TooLargeError(_too_much())
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        if number in (signal.SIGXCPU, signal.SIGKILL):
            raise TooLargeError(_too_much())
        message = f"it could not be read: reading it ended with {signal.Signals(number).name}"
        raise UnreadableError(message)
    if os.WEXITSTATUS(status) != 0 or not answer:
        raise TooLargeError(_too_much())  # not even memory for the answer was left
    try:
        fine, value = _Unpacker(io.BytesIO(answer)).load()
    except Exception as error:
        message = f"What was read cannot be taken: {error}. Please report that."
        raise MachineError(message) from error
    if not fine:
        raise value
    return value


def _too_much() -> str:
    return f"it is too large to be read within {CPU_S} s and {MEMORY // 1024**3} GiB of memory"


class _Packer(pickle.Pickler):
    """Packs members of enumerations and errors of ours as calls of their classes, whatever others have registered."""

    def reducer_override(self, obj: object) -> Any:  # noqa: ANN401 - as the base class
        """How to make it again."""
        if isinstance(obj, Enum):
            return type(obj), (obj.value,)
        return (type(obj), obj.args) if isinstance(obj, GraderError) else NotImplemented


class _Unpacker(pickle.Unpickler):
    """Takes dataclasses and errors of ours and what they are made of: the child has read what a stranger wrote."""

    def find_class(self, module: str, name: str) -> Any:  # noqa: ANN401 - a class
        """The class, if it is one of these."""
        if name in _STANDARD.get(module.partition(".")[0], ()):
            return super().find_class(module, name)
        found = getattr(import_module(module), name, None) if module.startswith("grader.") else None
        if isinstance(found, type) and (is_dataclass(found) or issubclass(found, Enum | GraderError)):
            return found
        message = f"{module}.{name} is not read"
        raise pickle.UnpicklingError(message)
