"""Start the kernel in its sandbox cell, and forward messages through the cell's standard input and output.

    python -m grader.notebook.bridge FOLDER WORKSPACE

The kernel's sockets are on the cell's disk, so the cell does not need write access to a folder outside the cell. The
relay that reads the pipes (grader.gradebook.relay) limits the amount of data. FOLDER is a read-only copy of the
submission. The kernel works on a second copy of the submission, in WORKSPACE.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import zmq

from grader.common.interpreter import interpreter
from grader.common.linux_calls import pidfd_open
from grader.notebook.frames import CHANNELS, CHUNK, ORDER, Unpacker, packed

IDENTITY = b"bridge"
"""The identity of the bridge on all channels. The kernel sends an input request to the identity that sent the code."""
RETRY_MS = 10
"""The interval between attempts to connect to a kernel that is starting (ms)."""
LAST_MS = 100
"""The maximum time to wait for each further message of a kernel that has exited (ms)."""
_IOPUB = CHANNELS.index("iopub")


class Bridge:
    """The sockets of a kernel, and the messages that wait until the kernel is listening."""

    def __init__(self, folder: Path, key: dict[str, Any]) -> None:
        """Create the sockets in `folder`. `key` contains the signature settings from the connection file."""
        self.connection_file = folder / "kernel.json"
        info = {"transport": "ipc", "ip": str(folder / "socket"), "kernel_name": "", **key}
        self._context = zmq.Context()
        self._sockets: list[zmq.Socket[bytes]] = []
        for number, name in enumerate((*CHANNELS, "hb"), 1):
            info[f"{name}_port"] = number
            if name != "hb":
                self._sockets.append(self._connect(name, f"ipc://{info['ip']}-{number}"))
        self.connection_file.write_text(json.dumps(info), encoding="utf-8")
        self._waiting: list[tuple[int, list[bytes]]] | None = []

    def _connect(self, name: str, address: str) -> zmq.Socket[bytes]:
        socket = self._context.socket(zmq.SUB if name == "iopub" else zmq.DEALER)
        socket.set_hwm(0)
        socket.linger = 0
        socket.reconnect_ivl = RETRY_MS
        if name == "iopub":
            socket.subscribe(b"")
        else:
            socket.identity = IDENTITY
        socket.connect(address)
        return socket

    def send(self, channel: int, parts: list[bytes]) -> None:
        """Forward a message to the kernel.

        A message is kept until the kernel's replies can be received, and is then sent.
        """
        if self._waiting is not None:
            self._waiting.append((channel, parts))
        elif channel < _IOPUB:
            self._sockets[channel].send_multipart(parts)

    def serve(self, kernel: int) -> None:
        """Forward messages until the end of standard input, or until the process of `kernel` (a pidfd) exits."""
        poller = zmq.Poller()
        for number in (0, kernel, *self._sockets):
            poller.register(number, zmq.POLLIN)
        unpacker = Unpacker()
        while True:
            ready = dict(poller.poll())
            self._hear()
            if kernel in ready:
                while zmq.select(self._sockets, [], [], LAST_MS / 1000)[0]:
                    self._hear()
                return
            if 0 in ready:
                data = os.read(0, CHUNK)
                if not data:
                    return
                for channel, parts in unpacker.feed(data):
                    self.send(channel, parts)

    def _hear(self) -> None:
        """Forward the messages of the kernel."""
        for channel, socket in enumerate(self._sockets):
            while socket.poll(0):
                data = memoryview(packed(channel, socket.recv_multipart()))
                while data:
                    data = data[os.write(1, data) :]
                if channel == _IOPUB and self._waiting is not None:
                    # The first message of the kernel welcomes a new subscriber. From now on, no message is lost.
                    waiting, self._waiting = self._waiting, None
                    for each in waiting:
                        self.send(*each)


def main() -> None:
    """Start the kernel and forward its messages until the kernel exits or standard input ends."""
    folder, workspace = sys.argv[1:]
    unpacker, orders = Unpacker(), list[tuple[int, list[bytes]]]()
    while not orders:
        data = os.read(0, CHUNK)
        if not data:
            return
        orders += unpacker.feed(data)
    (channel, (key,)), *others = orders
    assert channel == ORDER
    with tempfile.TemporaryDirectory(prefix="kernel-", ignore_cleanup_errors=True) as sockets:
        bridge = Bridge(Path(sockets), json.loads(key))
        for other in others:
            bridge.send(*other)
        kernel = interpreter(
            *("-m", "grader.notebook.confined_kernel", folder, workspace, "-f", str(bridge.connection_file)),
            searches=True,
        )
        null = subprocess.DEVNULL
        with subprocess.Popen(kernel.argv, env=kernel.env, stdin=null, stdout=null, stderr=null) as child:
            try:
                bridge.serve(pidfd_open(child.pid))
            finally:
                child.kill()


if __name__ == "__main__":
    main()
