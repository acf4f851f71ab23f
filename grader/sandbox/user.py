"""Who a room or cell is outside of its namespaces: where root grades, a user of its own, whom no other cell is.

The kernel counts some things per user: the pages of pipes, instances of inotify, signals and timers that wait, sockets
on their way. Cells of one user could take them from each other. So each gets a number of its own from a range that
nobody else uses, and keeps it as long as it lives. Whoever has a number locks the byte of that number in one file: the
lock holds among all graders of a machine, and ends with the grader.
"""

from __future__ import annotations

import fcntl
import os
import random
import stat
import struct
import tempfile
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from grader.errors import MachineError

if TYPE_CHECKING:
    from collections.abc import Iterator

FIRST_USER = 2_000_000_000
"""Given to nobody: https://systemd.io/UIDS-GIDS. Debian's policy does not go so far either."""
USERS = 65_536
FEW_USERS = range(65_520, 65_534)
"""For containers that have no others: in no range that systemd or Debian's policy gives to users or services."""
MAP = Path("/proc/self/uid_map")
PLACES = ("/run", "/var/run")
"""Where the file is kept, the first that there is; else among the temporary files."""
TRIES = 10_000


@contextmanager
def cell_user() -> Iterator[int | None]:
    """A number that no other living room or cell of this machine has; None unless the caller is root.

    Leave it after the last process of the room or cell has been waited for.

    Raises:
        MachineError: so many cells live that there is none left, or the file cannot be kept.
    """
    if os.geteuid() != 0:
        yield None
        return
    users = _users(MAP.read_text("ascii"))
    try:
        file = os.open(_folder() / "users.lock", os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
    except OSError as error:
        message = f"The list of the users of cells could not be opened: {error}."
        raise MachineError(message) from error
    try:
        # At random, so that the number of a cell whose grader was just killed is not the next one's.
        for user in random.choices(users, k=TRIES):
            if _lock(file, user):
                break
        else:
            message = "No user is left for a cell: too many cells run on this machine. Wait until others have ended."
            raise MachineError(message)
        yield user
    finally:
        os.close(file)


def _users(uid_map: str) -> range:
    """Who may be chosen, by the users that there are in this namespace (uid_map of user_namespaces(7))."""
    for line in uid_map.splitlines():
        first, _, count = map(int, line.split())
        if first <= FIRST_USER and first + count >= FIRST_USER + USERS:
            return range(FIRST_USER, FIRST_USER + USERS)
    return FEW_USERS


def _folder() -> Path:
    """A folder that is root's alone."""
    top = next((place for place in PLACES if os.access(place, os.W_OK)), tempfile.gettempdir())
    folder = Path(top) / "ros2-grader"
    with suppress(FileExistsError):
        folder.mkdir(mode=0o700)
    about = folder.lstat()
    if not stat.S_ISDIR(about.st_mode) or about.st_uid != 0 or about.st_mode & 0o077:
        message = f"{folder} is not a folder of root's alone: remove it."
        raise MachineError(message)
    return folder


def _lock(file: int, byte: int) -> bool:
    """Lock a byte of the file for this open file and nobody else (F_OFD_SETLK of fcntl(2))."""
    # struct flock: type, whence, start, length, pid.
    wanted = struct.pack("hhqqi4x", fcntl.F_WRLCK, os.SEEK_SET, byte, 1, 0)
    try:
        fcntl.fcntl(file, fcntl.F_OFD_SETLK, wanted)
    except (BlockingIOError, PermissionError):
        return False
    return True
