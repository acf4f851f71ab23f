"""One sentence for each system error, saying what to do: no disk space, no memory, no more files or processes.

Like machine.py, this module runs under any Python 3 before anything is installed, so it uses the syntax of Python 3.6.
"""

import errno
import os
import resource
from typing import Optional

OF_THE_DISK = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EROFS})
"""Errors which mean that the disk is full or broken. Any other error concerns a single file."""
ROOM = "free some space there, or set another folder with XDG_CACHE_HOME, XDG_STATE_HOME or TMPDIR"
_SCARCE = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.EAGAIN, errno.EIO})
_NOT_ALLOWED = "see the output of `grader doctor`"


def refusal(error: BaseException) -> Optional[str]:
    """Return the sentence for an error raised by the operating system, or None for any other error."""
    if isinstance(error, MemoryError):
        return sentence(errno.ENOMEM)
    if isinstance(error, RuntimeError):
        return sentence(errno.EAGAIN) if "start new thread" in str(error) else refusal_in(str(error))
    if isinstance(error, OSError):
        where = os.fsdecode(error.filename) if isinstance(error.filename, (str, bytes)) else ""
        return sentence(error.errno or 0, where)
    return None


def refusal_in(said: str) -> Optional[str]:
    """Return a sentence for users if the message `said` mentions a lack of disk space, memory, files or processes."""
    found = next((number for number in sorted(_SCARCE) if os.strerror(number) in said), None)
    return sentence(found) if found else None


def of_the_machine(error: OSError) -> bool:
    """Return whether the error means that the machine has no disk space, memory, files or processes left."""
    return error.errno in _SCARCE


def sentence(number: int, where: str = "", room: str = ROOM) -> str:
    """Return the sentence that describes a system error (errno) to users.

    `where` is the path that caused the error. `room` says what to do if a disk is full.
    """
    at = f" for {where}" if where else ""
    if number in (errno.ENOSPC, errno.EDQUOT):
        return f"The disk is full{at}: {room}."
    if number == errno.EROFS:
        return f"The disk cannot be written to{at}: {room}."
    if number == errno.EMFILE:
        most = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
        return f"The grader may not open more than {most} files: raise this limit, for example with `ulimit -n 4096`."
    if number == errno.ENFILE:
        return "This machine has too many files open: end other programs."
    if number == errno.ENOMEM:
        return "This machine has no memory left: end other programs, or grade fewer submissions at once (--jobs)."
    if number == errno.EAGAIN:
        return "This machine cannot start more processes for you: end other programs, or raise the limit (`ulimit -u`)."
    what = os.strerror(number) if number else "it gave no reason"
    return f"The system did not allow something that the grader needs{at} ({what}): {_NOT_ALLOWED}."
