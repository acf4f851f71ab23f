"""The address of a view. The address is reachable only from this machine, and stays the same if possible.

The port and the token are stored for each user and kind of view, so that an open tab can connect to a restarted
simulator.
"""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import socket
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

from grader.common import xdg
from grader.errors import UsageError

if TYPE_CHECKING:
    from pathlib import Path

HOST = "127.0.0.1"
_TOKEN_BYTES = 16
_TOKEN_CHARS = 22
"""The length of the token in characters: 16 bytes in base 64."""


@dataclass(frozen=True)
class Address:
    """A port on 127.0.0.1, and the token that a page needs to read the state and to drive the turtles."""

    port: int
    token: str

    @property
    def url(self) -> str:
        """The URL to open. Browsers do not send the part after the #, so only scripts of the page send the token."""
        return f"http://{HOST}:{self.port}/#{self.token}"


@dataclass(frozen=True)
class Place:
    """An address and its listening socket.

    If an earlier view used the address, `before` is True, since a tab may still be open.
    """

    address: Address
    listening: socket.socket
    before: bool


def listen(kind: str, port: int | None = None) -> Place:
    """Listen on `port` if given, else on the stored port of this kind of view if it is free, else on any free port.

    Raises:
        UsageError: the port is not available.
    """
    kept = remembered(kind)
    token = kept.token if kept else secrets.token_urlsafe(_TOKEN_BYTES)
    listening = _bound(port) if port is not None else _free(kept.port if kept else 0)
    address = Address(listening.getsockname()[1], token)
    # Do not store the port of a second view. The next view should use the port of the first one.
    if kept is None or port is not None:
        _remember(kind, address)
    return Place(address, listening, before=kept == address)


def _bound(port: int) -> socket.socket:
    try:
        return _socket(port)
    except (OSError, OverflowError) as error:
        reason = getattr(error, "strerror", None) or "ports are numbers from 0 to 65535"
        message = f"--port {port} is not available: {reason}. Without --port, a free port is used."
        raise UsageError(message) from error


def _free(preferred: int) -> socket.socket:
    try:
        return _socket(preferred)
    except (OSError, OverflowError):
        return _socket(0)


def _socket(port: int) -> socket.socket:
    with contextlib.ExitStack() as stack:
        made = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_STREAM))
        # Allow a port on which the last view's connections are still closing. A port on which another process is
        # listening fails.
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.bind((HOST, port))
        made.listen(128)
        stack.pop_all()
        return made


def _file(kind: str) -> Path:
    return xdg.state() / f"view-{kind}.json"


def remembered(kind: str) -> Address | None:
    """Return the last address of this kind of view, or None. The view at this address may no longer be running."""
    file = _file(kind)
    try:
        stat = file.stat()
        kept = Address(**json.loads(file.read_text("utf-8")))
    except (OSError, ValueError, TypeError):
        return None
    # Ignore a file that other users can read or write, because its token is not secret.
    ours = stat.st_uid == os.getuid() and not stat.st_mode & 0o077
    whole = isinstance(kept.port, int) and isinstance(kept.token, str) and len(kept.token) >= _TOKEN_CHARS
    return kept if ours and whole else None


def _remember(kind: str, address: Address) -> None:
    """Store the address for the next view. Do nothing if the file cannot be written."""
    file = _file(kind)
    new = file.with_suffix(f".{os.getpid()}")
    with contextlib.suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        with contextlib.suppress(FileNotFoundError):
            new.unlink()
        descriptor = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(descriptor, "w", encoding="utf-8") as written:
            json.dump(asdict(address), written)
        new.replace(file)
