"""Run a kernel in a sandbox cell, and forward its messages to nbgrader within certain limits.

    python -m grader.gradebook.relay FOLDER

FOLDER contains `order.json` (the command to start) and nbgrader's connection file. The relay creates its sockets in
this folder. Only the caller has access to this folder. The cell sees nothing of this folder except the copy of the
submission. Messages from the kernel arrive through a pipe (grader.notebook.bridge). If a budget or a limit is exceeded,
the relay stops the cell, writes the reason to `why`, and exits. The relay also exits when nbgrader exits, because
nbgrader's exit closes the relay's standard input.
"""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import zmq

from grader.gradebook.budget import Account, Budget
from grader.notebook.frames import CHANNELS, CHUNK, ORDER, FrameError, Unpacker, packed
from grader.sandbox.bubblewrap import View, lone_cell
from grader.sandbox.control_group import control_group
from grader.sandbox.limits import MIB, Limits, allowed
from grader.sandbox.system_calls import call_filter
from grader.sandbox.usage import EVERY_S, Guard
from grader.sandbox.user import cell_user

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

ORDER_FILE, WHY_FILE = "order.json", "why"
MOST_MEMORY = 1024 * MIB
"""The limit on the relay's address space (bytes)."""
MOST_WAITING = MIB
"""While at least this number of bytes is pending for the kernel, the relay reads no further messages for the kernel."""
LINGER_MS = 1000
_IOPUB = CHANNELS.index("iopub")


@dataclass(frozen=True)
class Order:
    """The command that the relay starts: a bridge, which runs in a cell if `confined` is True."""

    argv: Sequence[str]
    env: Mapping[str, str]
    view: View
    confined: bool
    connection_file: str

    def write(self, folder: Path) -> None:
        """Write this command to order.json in the relay's folder."""
        (folder / ORDER_FILE).write_text(json.dumps(asdict(self), default=str), encoding="utf-8")

    @classmethod
    def read(cls, folder: Path) -> Order:
        """Read the command that `write` has written."""
        data = json.loads((folder / ORDER_FILE).read_text("utf-8"))
        view = View(**{name: tuple(map(Path, paths)) for name, paths in data.pop("view").items()})
        return cls(**data, view=view)


class Relay:
    """The connection between nbgrader's sockets and the pipes of a cell."""

    def __init__(self, info: Mapping[str, Any], cell: subprocess.Popen[bytes]) -> None:
        """Open the sockets. `info` is the content of the connection file."""
        assert cell.stdin is not None
        assert cell.stdout is not None
        self._in, self._out = cell.stdin.fileno(), cell.stdout.fileno()
        os.set_blocking(self._in, False)
        self._account = Account(info["key"].encode())
        self._unpacker = Unpacker(Budget.message)
        key = {name: info[name] for name in ("key", "signature_scheme")}
        self._to_kernel = bytearray(packed(ORDER, [json.dumps(key).encode()]))
        self._early: list[list[bytes]] | None = []
        self._context = zmq.Context()
        self._sockets = [self._bind(name, f"ipc://{info['ip']}-{info[f'{name}_port']}") for name in CHANNELS]
        self._beat = self._bind("hb", f"ipc://{info['ip']}-{info['hb_port']}")

    def _bind(self, name: str, address: str) -> zmq.Socket[bytes]:
        socket = self._context.socket(zmq.XPUB if name == "iopub" else zmq.ROUTER)
        # A budget limits messages to nbgrader. Messages from nbgrader are read only at the speed of the kernel.
        socket.sndhwm, socket.rcvhwm = 0, 1
        socket.linger = LINGER_MS
        socket.bind(address)
        return socket

    def serve(self, over: Sequence[str]) -> None:
        """Forward messages until the cell or nbgrader exits, or until `over` is not empty.

        Raises:
            FrameError: the kernel has exceeded its budget, or has sent data that is not a message.
        """
        poller = zmq.Poller()
        for number in (0, self._out, self._beat, self._sockets[_IOPUB]):
            poller.register(number, zmq.POLLIN)
        while not over:
            poller.register(self._in, zmq.POLLOUT if self._to_kernel else 0)
            for socket in self._sockets[:_IOPUB]:
                poller.register(socket, zmq.POLLIN if len(self._to_kernel) < MOST_WAITING else 0)
            ready = dict(poller.poll(int(EVERY_S * 1000)))
            if 0 in ready:
                return
            if self._out in ready and not self._hear():
                return
            if self._beat in ready:
                self._beat.send_multipart(self._beat.recv_multipart())
            self._take_from_nbgrader(ready)

    def close(self) -> None:
        """Deliver the remaining messages, and then close nbgrader's sockets."""
        self._context.destroy()

    def _hear(self) -> bool:
        """Read messages from the kernel. Return False at the end of the stream."""
        data = os.read(self._out, CHUNK)
        for channel, parts in self._unpacker.feed(data):
            self._account.take(parts)
            if channel == ORDER:
                raise FrameError("data that is not a Jupyter message")  # noqa: EM101
            if channel == _IOPUB and self._early is not None:
                self._early.append(parts)
            else:
                self._sockets[channel].send_multipart(parts)
        return bool(data)

    def _take_from_nbgrader(self, ready: Mapping[Any, int]) -> None:
        for channel, socket in enumerate(self._sockets):
            if socket not in ready:
                continue
            parts = socket.recv_multipart()
            if channel != _IOPUB:
                self._to_kernel += packed(channel, parts)
            elif self._early is not None:
                # nbgrader has subscribed.
                early, self._early = self._early, None
                for each in early:
                    socket.send_multipart(each)
        if self._to_kernel:
            try:
                del self._to_kernel[: os.write(self._in, self._to_kernel[:CHUNK])]
            except BlockingIOError:
                pass
            except BrokenPipeError:
                self._to_kernel.clear()  # the kernel has exited, which `_hear` reports


def run(order: Order, info: Mapping[str, Any]) -> str:
    """Run the cell until it or nbgrader exits, or until a limit is exceeded.

    Return the reason if a limit was exceeded or the kernel sent wrong data, or else an empty string.
    """
    limits = Limits()
    over: list[str] = []
    with ExitStack() as stack:
        argv = list(order.argv)
        filter_fd = stack.enter_context(call_filter())
        group = stack.enter_context(control_group(limits))
        if order.confined:
            user = stack.enter_context(cell_user())
            argv = lone_cell(argv, order.view, env=order.env, limits=limits, user=user, filter_fd=filter_fd)
        cell = subprocess.Popen(
            group.joined(argv),
            env=dict(order.env),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            # A student's output on the instructor's terminal could control this terminal.
            stderr=subprocess.DEVNULL,
            pass_fds=() if filter_fd is None else (filter_fd,),
        )
        stack.callback(cell.wait)
        stack.callback(cell.kill)
        guard = Guard([cell.pid], limits, over.append)
        stack.callback(guard.close)
        relay = Relay(info, cell)
        stack.callback(relay.close)
        try:
            relay.serve(over)
        except FrameError as error:
            return f"The kernel sent {error}."
        except MemoryError:
            return "The kernel sent more data than the relay could read."
        if group.out_of_memory():
            over.append("memory")
    return f"The notebook exceeded its limit on {over[0]}." if over else ""


def main() -> None:
    """Run the relay as specified in the folder's order.json."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    folder = Path(sys.argv[1])
    order = Order.read(folder)
    info = json.loads(Path(order.connection_file).read_text("utf-8"))
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    resource.setrlimit(resource.RLIMIT_AS, (allowed(resource.RLIMIT_AS, MOST_MEMORY), hard))
    why = run(order, info)
    if why:
        (folder / WHY_FILE).write_text(why, encoding="utf-8")


if __name__ == "__main__":
    main()
