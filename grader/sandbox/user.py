"""Choose a different user for each sandbox room or cell when root grades.

The kernel limits some resources per user: pipe pages, inotify instances, pending signals and timers, and file
descriptors in transit. One cell could use up these resources, so that none would be left for other cells of the same
user. Therefore, each room or cell gets a user id from a range that nothing else uses, and keeps the user id until it
ends. To reserve an id, the grader locks the byte whose position in a file is the id. All graders on a machine respect
the lock, which is released when the grader exits.
"""

from __future__ import annotations

import fcntl
import os
import random
import struct
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.linux_calls import F_OFD_SETLK
from grader.common.private_folder import private_folder
from grader.errors import MachineError

if TYPE_CHECKING:
    from collections.abc import Iterator

FIRST_USER = 2_000_000_000
"""The first of a range of ids that are not assigned to users or services (systemd.io/UIDS-GIDS and Debian's policy)."""
USERS = 65_536
FEW_USERS = range(65_520, 65_534)
"""The ids that are used instead in a container without the ids from FIRST_USER on. systemd and Debian's policy do not
assign these ids to users or services either."""
MAP = Path("/proc/self/uid_map")
PLACES = ("/run", "/var/run")
"""The possible folders of the lock file. The first folder that is writable is used, or else the folder for temporary
files."""
TRIES = 10_000


@contextmanager
def cell_user() -> Iterator[int | None]:
    """Yield a user id that no other sandbox room or cell on this machine uses, or None if the caller is not root.

    Leave the context after the last process in the room or cell has exited.

    Raises:
        MachineError: all ids are in use, or the lock file or its folder cannot be used.
    """
    if os.geteuid() != 0:
        yield None
        return
    users = _users(MAP.read_text("ascii"))
    try:
        file = os.open(_folder() / "users.lock", os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
    except OSError as error:
        message = f"The lock file for the user ids of sandboxes could not be opened: {error}."
        raise MachineError(message) from error
    try:
        # Choose a random id, so that a new cell rarely gets the id of a cell whose grader was just killed.
        for user in (random.choice(users) for _ in range(TRIES)):
            if _lock(file, user):
                break
        else:
            message = (
                "All user ids for sandboxes are in use, because too many sandboxes run on this machine. Wait until "
                "other sandboxes have ended."
            )
            raise MachineError(message)
        yield user
    finally:
        os.close(file)


def _users(uid_map: str) -> range:
    """Return the user ids that this namespace can use, according to its uid_map (user_namespaces(7))."""
    for line in uid_map.splitlines():
        first, _, count = map(int, line.split())
        if first <= FIRST_USER and first + count >= FIRST_USER + USERS:
            return range(FIRST_USER, FIRST_USER + USERS)
    return FEW_USERS


def _folder() -> Path:
    """Return a folder that only root can write to. Create it if necessary."""
    above = next((place for place in PLACES if os.access(place, os.W_OK)), tempfile.gettempdir())
    return private_folder(Path(above), "ros2-grader")


def _lock(file: int, byte: int) -> bool:
    """Lock a byte of the file with F_OFD_SETLK of fcntl(2). Return False if the byte is already locked."""
    # The fields of struct flock are type, whence, start, length, pid.
    wanted = struct.pack("hhqqi4x", fcntl.F_WRLCK, os.SEEK_SET, byte, 1, 0)
    try:
        fcntl.fcntl(file, F_OFD_SETLK, wanted)
    except (BlockingIOError, PermissionError):
        return False
    return True
