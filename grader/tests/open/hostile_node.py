"""A hostile node of step 03 that prints the data that it could read, write and reach, and leaves a process behind.

test_node_in_cell.py replaces the words in capital letters.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable


def attempt(call: Callable[[], object]) -> None:
    try:
        print(call(), flush=True)
    except OSError as error:
        print(error, flush=True)


def send(port: int) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.sendto(b"hostile", ("127.0.0.1", port))


def main() -> None:
    attempt(Path("HOME/.secret").read_text)
    attempt(lambda: Path("HOME/written").write_text("hostile"))
    attempt(lambda: Path("WORKSPACE/written").write_text("hostile"))
    attempt(lambda: socket.create_connection(("127.0.0.1", int("TCP_PORT")), 5).close())
    for port in json.loads("[UDP_PORTS]"):
        attempt(partial(send, port))
    if os.fork() == 0:
        os.setsid()
        for fd in (0, 1, 2):
            os.close(fd)
        os.execv("/bin/sh", ["LEFT_BEHIND", "-c", "sleep 600; true"])
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    print("all was tried", flush=True)
    time.sleep(600)


if __name__ == "__main__":
    main()
