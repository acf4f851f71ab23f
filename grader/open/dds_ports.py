"""The UDP ports of the nodes in a cell, and of the DDS participants on this machine that these nodes may reach.

A participant has two ports that depend on the domain and on its number (DDSI-RTPS, 9.6.1.1). In addition, the DDS
reader with which rmw_fastrtps receives ros_discovery_info gets the first free port from 7000 on, in every domain.
"""

from __future__ import annotations

import socket
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING

from grader.errors import MachineError

if TYPE_CHECKING:
    from collections.abc import Iterable

HOST = "127.0.0.1"
PARTICIPANTS = 32
"""The number of participants to which a new node announces itself (maxInitialPeersRange in graph/loopback.xml)."""
FIRST_OWN = 7000
OTHERS = 64
"""This number of ports, beginning with FIRST_OWN, is reserved for the other nodes of this machine."""
_TRIED = 64
OWN = 4
"""The maximum number of participants in a cell that other nodes can reach. A program has one participant for each
context, and a node that the program starts as a child process has another participant."""


def participant_ports(domain: int, number: int) -> tuple[int, int]:
    """Return the ports of a participant for discovery and for messages. The first port is even."""
    first = 7400 + 250 * domain + 10 + 2 * number
    return first, first + 1


@dataclass(frozen=True)
class Ports:
    """`own` contains the sockets outside the cell that receive data for the nodes in the cell.

    `others` contains the ports of other nodes.

    Inside the cell, sockets of the relay occupy the ports in `others`. Therefore, the nodes in the cell get the
    remaining ports, which have the same numbers as the sockets in `own` outside the cell. `discovery` contains those
    ports of `own` that receive discovery data.
    """

    own: tuple[socket.socket, ...]
    others: tuple[int, ...]
    discovery: frozenset[int]


def reserve(domain: int) -> Ports:
    """Bind the ports for as many participants as possible, but at most OWN. Return the ports.

    The port numbers are high, because nodes use the lowest free ports.

    Raises:
        MachineError: too few ports are free.
    """
    own: dict[int, tuple[socket.socket, ...]] = {}
    for number in reversed(range(PARTICIPANTS)):
        if len(own) < OWN and (pair := _bound(participant_ports(domain, number))):
            own[number] = pair
    if not own:
        message = f"Too many nodes are running in ROS domain {domain} on this machine. Stop some of them."
        raise MachineError(message)
    sockets = tuple(chain.from_iterable(own.values()))
    for first in range(FIRST_OWN + OTHERS, FIRST_OWN + OTHERS + _TRIED):
        if readers := _bound(range(first, first + len(own))):
            pairs = (participant_ports(domain, other) for other in range(PARTICIPANTS) if other not in own)
            others = (*chain.from_iterable(pairs), *range(FIRST_OWN, first))
            discovery = frozenset(participant_ports(domain, number)[0] for number in own)
            return Ports((*sockets, *readers), others, discovery)
    for each in sockets:
        each.close()
    first, last = FIRST_OWN + OTHERS, FIRST_OWN + OTHERS + _TRIED + len(own) - 2
    message = f"Too few of the ports {first} to {last} of this machine are free. Stop some nodes."
    raise MachineError(message)


def _bound(ports: Iterable[int]) -> tuple[socket.socket, ...]:
    """Return a socket for each port, or an empty tuple if one of the ports is in use."""
    made: list[socket.socket] = []
    for port in ports:
        made.append(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        try:
            made[-1].bind((HOST, port))
        except OSError:
            for each in made:
                each.close()
            return ()
    return tuple(made)
