"""Landlock: a process gives up access to all files except those in a list (landlock(7), Linux 5.13 and later).

Later versions of Landlock can deny more kinds of access than the first version. The process that reads students' files
has two defences: Landlock and the filter in reading_calls.py.
"""

from __future__ import annotations

import ctypes
import os
import stat
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

# These system calls have the same numbers on all processors.
_CREATE, _ADD, _RESTRICT = 444, 445, 446
_VERSION = 1
_PATH_BENEATH = 1
_READ_FILE, _READ_FOLDER = 1 << 2, 1 << 3
_FILE_RIGHTS = {1: 13, 2: 14, 3: 15, 5: 16}
"""Maps a version of Landlock to the number of file rights that it supports, such as opening, executing, writing and
ioctl."""
_NET_RIGHTS = {4: 2}
"""Maps a version of Landlock to the number of network rights that it supports: binding and connecting TCP sockets."""
_SCOPES = {6: 2}
"""Maps a version of Landlock to the number of scopes that it supports: connections to abstract Unix sockets of other
processes, and signals to other processes."""
_SET_NO_NEW_PRIVILEGES = 38


class _Ruleset(ctypes.Structure):
    _fields_ = (("files", ctypes.c_uint64), ("net", ctypes.c_uint64), ("scopes", ctypes.c_uint64))


class _Below(ctypes.Structure):
    _pack_ = 1
    _fields_ = (("allowed", ctypes.c_uint64), ("folder", ctypes.c_int32))


def allow_only_reading(paths: Iterable[Path]) -> bool:
    """Permanently deny this thread every kind of access that Landlock controls, except reading these files and folders.

    Paths that do not exist are ignored. Return False if the kernel does not support Landlock or refuses.
    """
    c = ctypes.CDLL(None)
    version = c.syscall(_CREATE, None, ctypes.c_size_t(0), _VERSION)
    if version < 1:
        return False
    denied = _Ruleset(*(_bits(of, version) for of in (_FILE_RIGHTS, _NET_RIGHTS, _SCOPES)))
    rules = c.syscall(_CREATE, ctypes.byref(denied), ctypes.c_size_t(ctypes.sizeof(denied)), 0)
    if rules < 0:
        return False
    try:
        for path in paths:
            with suppress(OSError):
                _allow(c, rules, path)
        c.prctl(_SET_NO_NEW_PRIVILEGES, 1, 0, 0, 0)
        return bool(c.syscall(_RESTRICT, rules, 0) == 0)
    finally:
        os.close(rules)


def _bits(of: dict[int, int], version: int) -> int:
    return (1 << max((number for since, number in of.items() if since <= version), default=0)) - 1


def _allow(c: ctypes.CDLL, rules: int, path: Path) -> None:
    descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC)
    try:
        is_folder = stat.S_ISDIR(os.fstat(descriptor).st_mode)
        rule = _Below(_READ_FILE | (_READ_FOLDER if is_folder else 0), descriptor)
        c.syscall(_ADD, rules, _PATH_BENEATH, ctypes.byref(rule), 0)
    finally:
        os.close(descriptor)
