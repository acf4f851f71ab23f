"""Recognize that the disk of this machine has failed, which is not the fault of a student's file."""

from __future__ import annotations

import os
import shutil

from grader.common.system_errors import OF_THE_DISK, path_and_reason, sentence

_ROOM = "free some space there"


def failed_disk(error: BaseException | None, written: str | os.PathLike[str] = "") -> str:
    """Return a sentence if a full, broken or read-only disk is the cause of the error, or an empty string.

    `written` is the file or folder that was being written. The sentence names it if the error does not contain a path.
    """
    while error is not None:
        number = _errno(error) if isinstance(error, OSError) else 0
        if number and isinstance(error, OSError):
            # An error while copying also contains the file that was read, as its first file.
            where = error.filename2 if isinstance(error.filename2, str) else path_and_reason(error)[0]
            return sentence(number, where or os.fspath(written), _ROOM)
        error = error.__cause__ or error.__context__
    return ""


def _errno(error: OSError) -> int:
    """Return the errno of an error of the disk, or 0. A shutil.Error has no errno, only the texts of other errors."""
    if isinstance(error, shutil.Error):
        reason = path_and_reason(error)[1]
        return next((number for number in sorted(OF_THE_DISK) if os.strerror(number) in reason), 0)
    return error.errno if error.errno in OF_THE_DISK else 0
