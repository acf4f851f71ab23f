"""Start, query and stop the daemon from a command. Every command also works without the daemon."""

from __future__ import annotations

import json
import os
import socket
import time
from typing import Any

from grader.ros2.daemon import socket_path

ANSWER_S = 8.0
"""The maximum time to wait for a response (s). The daemon itself waits for a shorter time for nodes that do not
respond."""
_POLL_S = 0.02


def request(call: str) -> dict[str, Any] | None:
    """Return the daemon's response to "look", "ping" or "stop", or None if no valid response arrives."""
    folder = socket_path.folder()
    if folder is None:
        return None
    try:
        with (
            socket_path.address(folder, f"{socket_path.name()}.socket") as address,
            socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection,
        ):
            connection.settimeout(ANSWER_S)
            connection.connect(address)
            if not socket_path.is_ours(connection):
                return None
            connection.sendall(call.encode() + b"\n")
            text = b"".join(iter(lambda: connection.recv(1 << 16), b""))
        answer: dict[str, Any] = json.loads(text)
    except (OSError, ValueError):
        return None
    return answer


def is_running() -> bool:
    """Return whether a daemon responds."""
    return request("ping") is not None


def start(*, debug: bool = False) -> None:
    """Start a daemon, which exits immediately if another daemon is running.

    With `debug`, the daemon logs to this terminal.
    """
    # Most commands do not start a daemon, and so do not need these modules.
    import subprocess

    from grader.common.interpreter import interpreter

    target = None if debug else subprocess.DEVNULL
    server = interpreter("-m", "grader.ros2.daemon.server", *(["--debug"] if debug else []), searches=True)
    subprocess.Popen(
        server.argv,
        stdin=subprocess.DEVNULL,
        stdout=target,
        stderr=target,
        env=server.env,
        cwd="/",
        # Ctrl-C in this terminal must not stop the daemon.
        start_new_session=True,
    )


def start_for_later() -> None:
    """Start a daemon for the next command, unless GRADER_ROS2_DAEMON=0 disables daemons."""
    if os.environ.get("GRADER_ROS2_DAEMON") != "0" and socket_path.folder() is not None:
        start()


def wait_until_ended(timeout_s: float) -> bool:
    """Wait until the daemon's process has exited. Return False if the timeout expires first."""
    folder = socket_path.folder()
    if folder is None:
        return True
    end = time.monotonic() + timeout_s
    with (folder / f"{socket_path.name()}.lock").open("w") as file:
        while not socket_path.lock(file):
            if time.monotonic() >= end:
                return False
            time.sleep(_POLL_S)
    return True
