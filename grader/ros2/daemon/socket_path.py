"""The address of the daemon, which depends on the user, the domain and the network.

The socket is in a folder that only this user can access. The name of the socket also depends on other environment
variables that determine which graph a node discovers.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import socket
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import IO, TYPE_CHECKING

from grader.common import xdg

if TYPE_CHECKING:
    from collections.abc import Iterator

_ANSWERING = ("graph/*.py", "ros2/daemon/server.py")
"""The modules that determine the content and the form of the daemon's responses."""
_DECIDE = (
    "FASTDDS_BUILTIN_TRANSPORTS",
    "FASTDDS_DEFAULT_PROFILES_FILE",
    "FASTRTPS_DEFAULT_PROFILES_FILE",
    "RMW_IMPLEMENTATION",
    "ROS_AUTOMATIC_DISCOVERY_RANGE",
    "ROS_DISCOVERY_SERVER",
    "ROS_LOCALHOST_ONLY",
    "ROS_SECURITY_ENABLE",
    "ROS_SECURITY_KEYSTORE",
    "ROS_STATIC_PEERS",
)
"""The environment variables that, besides ROS_DOMAIN_ID, determine which graph a node discovers."""


def domain() -> str:
    """Return the domain id that the user has set, as text, or "0"."""
    return os.environ.get("ROS_DOMAIN_ID") or "0"


@cache
def version() -> str:
    """Return a string that changes with the code of the daemon."""
    package = Path(__file__).parents[2]
    whole = hashlib.sha256()
    for pattern in _ANSWERING:
        for file in sorted(package.glob(pattern)):
            whole.update(file.read_bytes())
    return whole.hexdigest()


def name() -> str:
    """Return the name of the daemon's socket.

    It is the same for all commands with the same user and settings. After an update of the course, it is another one,
    since the old daemon would respond as before.
    """
    network = Path("/proc/self/ns/net").stat().st_ino
    decisive = [version(), str(os.getuid()), str(network), domain()]
    decisive += [f"{variable}={os.environ.get(variable, '')}" for variable in _DECIDE]
    return f"ros2-{hashlib.sha256(chr(0).join(decisive).encode()).hexdigest()[:16]}"


def folder() -> Path | None:
    """Return the folder of the socket, created if necessary, or None if no private folder can be created."""
    runtime = os.environ.get("XDG_RUNTIME_DIR", "")
    for place in ([Path(runtime, "grader")] if runtime.startswith("/") else []) + [xdg.cache() / "daemon"]:
        try:
            place.mkdir(mode=0o700, parents=True, exist_ok=True)
            found = place.lstat()
        except OSError:
            continue
        if place.is_dir() and not place.is_symlink() and found.st_uid == os.getuid() and not found.st_mode & 0o077:
            return place
    return None


@contextmanager
def address(where: Path, which: str) -> Iterator[str]:
    """Yield a short path to the socket. The address of a socket is limited to 108 bytes, and its path may be longer."""
    descriptor = os.open(where, os.O_PATH | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        yield f"/proc/self/fd/{descriptor}/{which}"
    finally:
        os.close(descriptor)


def lock(file: IO[str]) -> bool:
    """Try to acquire the lock of the daemon. Return whether the lock was free."""
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def is_ours(connection: socket.socket) -> bool:
    """Return whether the process at the other end of the socket belongs to this user."""
    credentials = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, 12)
    return int.from_bytes(credentials[4:8], "little") == os.getuid()
