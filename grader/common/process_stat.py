"""The file stat of a process in /proc (see proc(5)).

This module needs only the standard library.
"""

from __future__ import annotations

EXITED = (b"Z", b"X")
"""The states of a thread that has exited."""


def stat_fields(stat: bytes) -> list[bytes]:
    """Return the fields of the file from the state of the main thread, [0], to the number of threads, [17]."""
    # A thread can have any name of up to 15 bytes, even ") R". The kernel's fields follow the last parenthesis.
    return stat[stat.rindex(b")") + 2 :].split(b" ", 18)


def has_exited(fields: list[bytes]) -> bool:
    """Return whether a process has exited. `fields` comes from `stat_fields`.

    If only the main thread has exited, its state is that of a zombie, although the process still runs.
    """
    return fields[0] in EXITED and int(fields[17]) <= 1
