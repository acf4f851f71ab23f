"""Handle Ctrl-C, SIGTERM and SIGHUP so that no object is left half created and no signal is lost."""

from __future__ import annotations

import signal
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType

_STOPS: tuple[int, ...] = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_SOON_S = 0.01


@contextmanager
def stops_deferred() -> Iterator[None]:
    """Until the end of the context, defer SIGINT, SIGTERM and SIGHUP if a Python function handles them.

    If an exception interrupts the `__init__` of some rclpy objects, destroying these objects prints a traceback.
    """
    arrived: list[int] = []

    def keep(number: int, _: FrameType | None) -> None:
        arrived.append(number)

    before = {number: handler for number in _STOPS if callable(handler := signal.getsignal(number))}
    for number in before:
        signal.signal(number, keep)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        for number in arrived:
            signal.raise_signal(number)


def raise_lost_stops() -> None:
    """From now on, raise a KeyboardInterrupt again if Python would otherwise only print it and discard it.

    Python discards an exception that is raised in a callback of `os.fork`, in `__del__` or in this hook, and the
    command would continue as if nobody had pressed Ctrl-C.
    """
    sys.unraisablehook = _raise_again


def _raise_again(discarded: sys.UnraisableHookArgs) -> None:
    if isinstance(discarded.exc_value, KeyboardInterrupt):
        _raise_soon(discarded.exc_value)
    elif not _is_half_created(discarded):
        sys.__unraisablehook__(discarded)


def _is_half_created(discarded: sys.UnraisableHookArgs) -> bool:
    """Return whether `__del__` did not find an attribute. Usually, Ctrl-C has interrupted the `__init__` of its object.

    For example, rclpy's executor creates a Task for each callback, so Ctrl-C may arrive at this moment.
    """
    return isinstance(discarded.exc_value, AttributeError) and getattr(discarded.object, "__name__", "") == "__del__"


def _raise_soon(lost: KeyboardInterrupt) -> None:
    def again(_number: int, frame: FrameType | None) -> None:
        if _is_during(frame, _raise_again, discard):  # Python would only print the exception
            signal.setitimer(signal.ITIMER_REAL, _SOON_S)
            return
        signal.signal(signal.SIGALRM, handler)
        signal.setitimer(signal.ITIMER_REAL, *rest)
        raise lost

    def discard(discarded: sys.UnraisableHookArgs) -> None:
        # The command ends soon, so other discarded exceptions are consequences of the interruption.
        if discarded.exc_value is lost:
            _raise_soon(lost)

    sys.unraisablehook = discard
    handler = signal.signal(signal.SIGALRM, again)
    rest = signal.setitimer(signal.ITIMER_REAL, _SOON_S)


def _is_during(frame: FrameType | None, *hooks: Callable[[sys.UnraisableHookArgs], None]) -> bool:
    codes = [hook.__code__ for hook in hooks]
    while frame and frame.f_code not in codes:
        frame = frame.f_back
    return frame is not None
