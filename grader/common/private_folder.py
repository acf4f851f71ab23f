"""A folder with a fixed name to which only this user has access, for files that several processes of the user share.

Other users can also create files in the folder for temporary files. If the grader opened a file with a fixed name in
that folder, another user could have created the file first, for example as a link to a file of the grader's user.
"""

from __future__ import annotations

import os
import stat
import tempfile
from contextlib import suppress
from pathlib import Path

from grader.common.system_errors import OF_THE_DISK
from grader.errors import DiskError, MachineError


def users_folder() -> Path:
    """Return the folder of this user in the folder for temporary files.

    Raises:
        MachineError: the folder cannot be created, or other users have access to it.
    """
    return private_folder(Path(tempfile.gettempdir()), f"ros2-grader-{os.getuid()}")


def private_folder(above: Path, name: str) -> Path:
    """Return the folder `name` in `above`. The folder is created if it does not exist.

    Raises:
        DiskError: the disk failed.
        MachineError: the folder cannot be created, or other users have access to it.
    """
    folder = above / name
    try:
        with suppress(FileExistsError):
            folder.mkdir(mode=0o700)
        about = folder.lstat()
    except OSError as error:
        message = f"{folder} could not be created: {error.strerror}."
        raise (DiskError if error.errno in OF_THE_DISK else MachineError)(message) from error
    if not stat.S_ISDIR(about.st_mode) or about.st_uid != os.geteuid() or about.st_mode & 0o077:
        message = f"{folder} must be a folder that only you can open. Remove it."
        raise MachineError(message)
    return folder
