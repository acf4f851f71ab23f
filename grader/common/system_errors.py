"""A sentence for each system error, such as a full disk or too many open files, that says what to do.

Like machine.py, this module runs under any Python from 3.6 on, before anything is installed, so it uses only the syntax
of Python 3.6.
"""

import errno
import os
import re
import resource
import sys
from typing import Optional, Tuple

OF_THE_DISK = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EROFS})
"""Errors that mean that the disk is full, broken or read-only."""
ROOM = "free some space there, or set another folder with XDG_CACHE_HOME, XDG_STATE_HOME or TMPDIR"
_WRITABLE = "use a folder on another disk, and also set XDG_CACHE_HOME, XDG_STATE_HOME and TMPDIR to such folders"
_SCARCE = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.EAGAIN, errno.EIO})
_SEE_DOCTOR = "see the output of `grader doctor`"

_NO_TEMPORARY_FOLDER = (
    "No folder for temporary files is writable: free some space in /tmp, or set another folder with TMPDIR."
)


def refusal(error: BaseException) -> Optional[str]:
    """Return the sentence for an error raised by the operating system, or None for any other error."""
    if isinstance(error, MemoryError):
        return sentence(errno.ENOMEM)
    if isinstance(error, RecursionError):
        return _refusal_behind(error)
    if isinstance(error, RuntimeError):
        return sentence(errno.EAGAIN) if "start new thread" in str(error) else refusal_in(str(error))
    if isinstance(error, OSError) and _is_of_shutil(error):
        path, reason = path_and_reason(error)
        return refusal_in(reason) or sentence(0, path)
    if isinstance(error, FileNotFoundError) and str(error.strerror).startswith("No usable temporary directory"):
        return _NO_TEMPORARY_FOLDER
    if isinstance(error, OSError):
        return sentence(error.errno or 0, path_and_reason(error)[0])
    return None


def _refusal_behind(error: BaseException) -> Optional[str]:
    """Return the sentence for the system error that Python was handling when `error` was raised, or None.

    For example, in Python 3.10 to 3.12, removing a temporary folder that the user is not allowed to open ends with a
    RecursionError.
    """
    behind = error.__context__
    while behind is not None and not isinstance(behind, OSError):
        behind = behind.__context__
    return refusal(behind) if behind else None


def refusal_in(said: str) -> Optional[str]:
    """Return the sentence for users if the message `said` contains the text of a known system error, else None."""
    found = next((number for number in sorted(_SCARCE) if os.strerror(number) in said), None)
    return sentence(found) if found else None


def _is_of_shutil(error: BaseException) -> bool:
    """Return whether this is a shutil.Error. shutil is not imported, since few commands need it."""
    shutil = sys.modules.get("shutil")
    return shutil is not None and isinstance(error, shutil.Error)


def path_and_reason(error: OSError) -> Tuple[str, str]:
    """Return the path that is named in a file system error ("" if there is none), and the reason.

    shutil.copytree raises a single error that contains a list with the errors of all files. The first error in this
    list is used.
    """
    if _is_of_shutil(error) and error.args and error.args[0]:
        _, path, said = error.args[0][0]
        found = re.match(r"\[Errno (\d+)\]", said)
        return str(path), os.strerror(int(found.group(1))) if found else said
    path = os.fsdecode(error.filename) if isinstance(error.filename, (str, bytes)) else ""
    return path, error.strerror or str(error) or "no reason given"


def of_the_machine(error: OSError) -> bool:
    """Return whether the machine has run out of disk space or memory, has too many open files, or has a broken disk.

    EAGAIN counts, too: the machine has too many processes.
    """
    return error.errno in _SCARCE


def sentence(number: int, where: str = "", room: str = ROOM) -> str:
    """Return the sentence that describes a system error (errno) to users.

    `where` is the path that caused the error. `room` says what to do if a disk is full.
    """
    at = f" for {where}" if where else ""
    if number in (errno.ENOSPC, errno.EDQUOT):
        return f"The disk is full{at}: {room}."
    if number == errno.EROFS:
        return f"The disk{f' of {where}' if where else ''} is read-only: {_WRITABLE}."
    if number == errno.EMFILE:
        most = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
        return f"The grader cannot open more than {most} files: raise this limit, for example with `ulimit -n 4096`."
    if number == errno.ENFILE:
        return "This machine has too many files open: close other programs."
    if number == errno.ENOMEM:
        return "This machine has no memory left: close other programs, or grade fewer submissions at once (--jobs)."
    if number == errno.EAGAIN:
        return "This machine cannot start more processes for you: close other programs, or raise `ulimit -u`."
    what = os.strerror(number) if number else "no reason given"
    return f"A system call of the grader failed{at} ({what}): {_SEE_DOCTOR}."
