"""Forward DDS datagrams between a node in a sandbox cell, with its own network, and the nodes of this machine.

A node in a cell can reach only this relay. The relay sends its datagrams only to ports of 127.0.0.1: the ports of the
participants in one ROS domain, and the ports that these participants have announced. To other nodes, the node in the
cell looks like a node of this machine.
"""

from __future__ import annotations

import re
import socket
import struct
from contextlib import suppress
from selectors import EVENT_READ
from typing import TYPE_CHECKING

from grader.open.dds_ports import FIRST_OWN, HOST, OTHERS, PARTICIPANTS, participant_ports

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from selectors import BaseSelector

    from grader.open.dds_ports import Ports

_LARGEST = 65536
_AT_ONCE = 64
_LOCATOR = re.compile(rb"(\x18\x00\x01\x00\x00\x00(..\x00\x00)\x00{12})[\x01-\xdf]...", re.DOTALL)
"""A unicast locator in discovery data: the length 24, the kind UDPv4, the port, the address (DDSI-RTPS, 9.6.2)."""
_HERE = socket.inet_aton(HOST)


class Relay:
    """Forwards datagrams.

    The caller must call the function in the `data` of each key that `selector` reports as ready.

    `inside` contains sockets in the cell's network. They are bound to the ports `ports.others`, in the same order.
    """

    def __init__(self, selector: BaseSelector, domain: int, ports: Ports, inside: Sequence[socket.socket]) -> None:
        pairs = (participant_ports(domain, number) for number in range(PARTICIPANTS))
        self._reachable = {port for pair in pairs for port in pair}
        self._outside = ports.own
        self._discovery = ports.discovery
        self._inside = inside
        for port, each in zip(ports.others, inside, strict=True):
            self._serve(selector, each, self._out, port)
        for each in ports.own:
            self._serve(selector, each, self._in, each.getsockname()[1])

    def close(self) -> None:
        """Close the sockets on both sides."""
        for each in (*self._outside, *self._inside):
            each.close()

    def _serve(
        self, selector: BaseSelector, each: socket.socket, pass_on: Callable[[bytes, int], object], port: int
    ) -> None:
        def receive() -> None:
            with suppress(OSError):  # nothing more has arrived, or the receiver's buffer is full
                for _ in range(_AT_ONCE):
                    pass_on(each.recv(_LARGEST), port)

        each.settimeout(0.0)
        selector.register(each, EVENT_READ, receive)

    def _out(self, datagram: bytes, port: int) -> None:
        if port in self._reachable:
            self._outside[0].sendto(datagram, (HOST, port))

    def _in(self, datagram: bytes, port: int) -> None:
        if port in self._discovery:
            datagram = _LOCATOR.sub(self._as_seen_inside, datagram)
        self._inside[0].sendto(datagram, (HOST, port))

    def _as_seen_inside(self, locator: re.Match[bytes]) -> bytes:
        """Return the locator with the address of this relay, which is the only address that the cell can reach.

        If the port in the locator is between FIRST_OWN and FIRST_OWN + OTHERS - 1, also allow datagrams to this port.
        """
        (port,) = struct.unpack("<I", locator[2])
        if FIRST_OWN <= port < FIRST_OWN + OTHERS:
            self._reachable.add(port)
        return locator[1] + _HERE
