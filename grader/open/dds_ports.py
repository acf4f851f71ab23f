"""The UDP ports of DDS participants on this machine: which of them a node in a cell gets, and which it may reach.

A participant has two ports that depend on the domain and on its number (DDSI-RTPS, 9.6.1.1). In addition, the reader
that rmw_fastrtps has for ros_discovery_info gets the first free port from 7000 on, whatever the domain.
"""

from __future__ import annotations

import socket
from dataclasses import dataclass
from itertools import chain

from grader.errors import MachineError

HOST = "127.0.0.1"
PARTICIPANTS = 32
"""A new node announces itself to this many participants (maxInitialPeersRange in graph/loopback.xml)."""
FIRST_OWN = 7000
OTHERS = 64
"""How many ports from FIRST_OWN on are left to the other nodes of this machine."""
_TRIED = 64


def participant_ports(domain: int, number: int) -> tuple[int, int]:
    """Return the ports for the discovery and for the messages of a participant. The first one is even."""
    first = 7400 + 250 * domain + 10 + 2 * number
    return first, first + 1


@dataclass(frozen=True)
class Ports:
    """`own` are the sockets outside of the cell for what is sent to the node. `others` are the ports of other nodes.

    Inside of the cell, `others` are taken. Therefore, the node gets the same ports there as `own`.
    """

    own: tuple[socket.socket, ...]
    others: tuple[int, ...]


def reserve(domain: int) -> Ports:
    """Bind the ports of one participant on this machine, and return them.

    The numbers are high, because nodes take the lowest free ones. A second participant of the same program would not
    be reachable, and hardly any program has one.

    Raises:
        MachineError: all ports are in use.
    """
    for number in reversed(range(PARTICIPANTS)):
        own = _bound(participant_ports(domain, number))
        if own:
            break
    else:
        message = f"Too many nodes run in ROS domain {domain} on this machine. End some of them."
        raise MachineError(message)
    for last in range(FIRST_OWN + OTHERS, FIRST_OWN + OTHERS + _TRIED):
        if reader := _bound((last,)):
            pairs = (participant_ports(domain, other) for other in range(PARTICIPANTS) if other != number)
            return Ports((*own, *reader), (*chain.from_iterable(pairs), *range(FIRST_OWN, last)))
    for each in own:
        each.close()
    message = f"The ports {FIRST_OWN} to {FIRST_OWN + OTHERS + _TRIED} of this machine are in use. End some nodes."
    raise MachineError(message)


def _bound(ports: tuple[int, ...]) -> tuple[socket.socket, ...]:
    """Return a socket for each port, or nothing if one of the ports is in use."""
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
