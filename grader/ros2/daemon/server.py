"""The daemon's process: a node that observes the graph, and a socket on which it responds to the user's commands.

The daemon exits after a long idle time, on request, or when its socket has been removed.
"""

from __future__ import annotations

import json
import os
import selectors
import signal
import socket
import sys
import time
import uuid
from contextlib import suppress
from typing import IO, TYPE_CHECKING, Any

from grader.ros.failure import Ros2Error
from grader.ros2.daemon import socket_path

if TYPE_CHECKING:
    from pathlib import Path
    from types import FrameType

    from rclpy.node import Node

    from grader.graph.discovery import Settling

IDLE_S = float(os.environ.get("GRADER_ROS2_DAEMON_IDLE_S", "1800"))
TICK_S = 1.0
_REQUEST_S = 2.0
"""The maximum time to wait for the request of a connected client (s)."""


def main() -> int:
    """Run the daemon.

    Return the exit code: 0, or 1 if no private folder for the socket can be created or the graph cannot be read. Return
    early if another daemon is running.
    """
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        signal.signal(number, _end)
    folder = socket_path.folder()
    if folder is None:
        return 1
    name = socket_path.name()
    with (folder / f"{name}.lock").open("w") as lock:
        if not socket_path.lock(lock):
            return 0
        try:
            _serve(folder, name, _replying())
        except KeyboardInterrupt:
            pass
        except Ros2Error as error:  # the commands then look at the graph themselves, and print the error
            print(error, file=sys.stderr)
            return error.exit_code
    return 0


def _replying() -> IO[str] | None:
    return sys.stderr if "--debug" in sys.argv[1:] else None


def _end(*_: int | FrameType | None) -> None:
    raise KeyboardInterrupt


def _serve(folder: Path, name: str, debug: IO[str] | None) -> None:
    # Import rclpy only now, so that a second daemon exits quickly.
    from grader.graph.discovery import Settling, cli_node

    file = folder / f"{name}.socket"
    with cli_node(f"_ros2cli_daemon_{socket_path.domain()}_{uuid.uuid4().hex}", patient=True) as node:
        # This process holds the lock, so the process that created the file has exited.
        file.unlink(missing_ok=True)
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as listening:
            before = os.umask(0o077)
            try:
                with socket_path.address(folder, file.name) as address:
                    listening.bind(address)
            finally:
                os.umask(before)
            listening.listen(64)
            made = file.stat()
            try:
                _answer_all(listening, node, Settling(node), lambda: _is_there(file, made), debug)
            finally:
                if _is_there(file, made):
                    file.unlink(missing_ok=True)


def _is_there(file: Path, made: os.stat_result) -> bool:
    try:
        now = file.stat()
    except OSError:
        return False
    return (now.st_dev, now.st_ino) == (made.st_dev, made.st_ino)


def _answer_all(listening: socket.socket, node: Node, settling: Settling, wanted: Any, debug: IO[str] | None) -> None:  # noqa: ANN401
    used = time.monotonic()
    with selectors.DefaultSelector() as selector:
        selector.register(listening, selectors.EVENT_READ)
        while wanted() and time.monotonic() - used < IDLE_S:
            # Check the graph regularly, so that the daemon can answer immediately if the graph has not changed.
            settling.observe()
            if not selector.select(TICK_S):
                continue
            connection, _ = listening.accept()
            with connection:
                used = time.monotonic()
                with suppress(OSError):
                    if not _answer(connection, node, settling, debug):
                        return


def _answer(connection: socket.socket, node: Node, settling: Settling, debug: IO[str] | None) -> bool:
    """Respond to a request. Return False if it was a request to stop."""
    from grader.graph.snapshot import snapshot

    connection.settimeout(_REQUEST_S)
    if not socket_path.is_ours(connection):
        return True
    call = b""
    while not call.endswith(b"\n"):
        more = connection.recv(64)
        if not more or len(call) > 64:
            return True
        call += more
    if debug is not None:
        print(f"{call.decode('utf-8', 'replace').strip()}()", file=debug, flush=True)
    answer: dict[str, Any] = {}
    if call == b"look\n":
        settling.settle()
        answer = snapshot(node).to_dict()
    connection.sendall(json.dumps(answer).encode())
    return call != b"stop\n"


if __name__ == "__main__":
    sys.exit(main())
