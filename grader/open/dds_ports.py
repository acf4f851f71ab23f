"""The UDP ports of DDS participants on this machine: the ports of a node in a cell, and the ports that it may reach.

A participant has two ports that depend on the domain and on its number (DDSI-RTPS, 9.6.1.1). In addition, the reader
that rmw_fastrtps has for ros_discovery_info gets the first free port from 7000 on, in every domain.
"""

from __future__ import annotations

import socket
from dataclasses import dataclass
from itertools import chain

from grader.errors import MachineError

HOST = "127.0.0.1"
PARTICIPANTS = 32
"""The number of participants to which a new node announces itself (maxInitialPeersRange in graph/loopback.xml)."""
FIRST_OWN = 7000
OTHERS = 64
"""The number of ports from FIRST_OWN on that are reserved for the other nodes of this machine."""
_TRIED = 64


def participant_ports(domain: int, number: int) -> tuple[int, int]:
    """Return the ports of a participant for discovery and for messages. The first port is even."""
    first = 7400 + 250 * domain + 10 + 2 * number
    return first, first + 1


@dataclass(frozen=True)
class Ports:
    """`own` contains the sockets outside the cell for data to the node. `others` contains the ports of other nodes.

    Inside the cell, the ports `others` are in use. Therefore, the node gets the same port numbers inside the cell as
    `own` has outside.
    """

    own: tuple[socket.socket, ...]
    others: tuple[int, ...]


def reserve(domain: int) -> Ports:
    """Bind the ports of one participant on this machine, and return them.

    The port numbers are high, because nodes use the lowest free ports. A second participant of the same program cannot
    be reached, but hardly any program has a second participant.

    Raises:
        MachineError: all ports are in use.
    """
    for number in reversed(range(PARTICIPANTS)):
        own = _bound(participant_ports(domain, number))
        if own:
            break
    else:
        message = f"Too many nodes run in ROS domain {domain} on this machine. Stop some of them."
        raise MachineError(message)
    for last in range(FIRST_OWN + OTHERS, FIRST_OWN + OTHERS + _TRIED):
        if reader := _bound((last,)):
            pairs = (participant_ports(domain, other) for other in range(PARTICIPANTS) if other != number)
            return Ports((*own, *reader), (*chain.from_iterable(pairs), *range(FIRST_OWN, last)))
    for each in own:
        each.close()
    message = f"The ports {FIRST_OWN} to {FIRST_OWN + OTHERS + _TRIED} of this machine are in use. Stop some nodes."
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
