"""Wait: the system call in which a thread is waiting, from the file syscall of the thread in /proc (see proc(5))."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

RUNNING = "running"
"""The value of `call` for a thread that is not waiting."""
HIDDEN = "hidden"
"""The value of `call` for a thread whose process forbids inspection (PR_SET_DUMPABLE of prctl(2))."""

# The system calls that only wait for time to pass, by their numbers on x86-64.
_SLEEPS = {35: "nanosleep", 230: "clock_nanosleep"}
_WITHIN = ("futex", RUNNING)
"""The values of `call` for a thread that waits only for other threads of its process, such as those of ROS 2."""
# For each system call that may have a timeout: its name, the word with the timeout (word 0 is the number of the call),
# and the values of that word that mean "no timeout".
_FOREVER = {0xFFFFFFFF, 0xFFFFFFFFFFFFFFFF}
_MAY_END = {
    202: ("futex", 4, {0}),
    7: ("poll", 3, _FOREVER),
    271: ("ppoll", 3, {0}),
    23: ("select", 5, {0}),
    270: ("pselect6", 5, {0}),
    232: ("epoll_wait", 4, _FOREVER),
    281: ("epoll_pwait", 4, _FOREVER),
}


@dataclass(frozen=True)
class Wait:
    """A thread and the system call in which it is waiting.

    `call` is the name of the system call, such as "futex", or "system call NUMBER" for most system calls. If the thread
    is not waiting, `call` is RUNNING. It can also be HIDDEN. `timed` is true if the wait has a timeout.
    """

    tid: int
    thread: str
    call: str
    timed: bool


def wait_of(tid: int, thread: str, words: list[str]) -> Wait:
    """Return how a thread waits. `words` is the content of the thread's file syscall."""
    if not words or not words[0].isdigit():
        return Wait(tid, thread, RUNNING, timed=False)
    number = int(words[0])
    if number in _SLEEPS:
        return Wait(tid, thread, _SLEEPS[number], timed=True)
    if number in _MAY_END:
        name, argument, never = _MAY_END[number]
        return Wait(tid, thread, name, timed=int(words[argument], 16) not in never)
    return Wait(tid, thread, f"system call {number}", timed=False)


def doubt(waits: Sequence[Wait], nodes: int) -> str | None:
    """Return why simulated time may misjudge `nodes` processes whose threads wait like this, or None.

    While a thread waits for anything outside its process (a child process, a pipe, a file), the process seems idle. If
    the clock advanced meanwhile, what the thread does next would come too late.
    """
    timed = [wait for wait in waits if wait.timed]
    if any(wait.call in _SLEEPS.values() for wait in timed):
        return "the node sleeps in wall time"
    # The wait of an executor has a timeout.
    if len(timed) > nodes:
        return "the node waits for wall time"
    if any(wait.call not in _WITHIN for wait in waits):
        return "the node waits for something that is not part of ROS 2"
    return None
