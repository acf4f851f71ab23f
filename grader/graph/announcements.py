"""Announce a new participant to the others on this machine as soon as the new participant can receive responses.

Fast DDS 2.14 sends the first announcement of a participant before the participant listens for responses. The other
participants respond immediately, and only to the first announcement. If a response is lost, the new participant does
not discover the responding participant until the latter announces itself again, after up to 3 s. Therefore, the
grader's participants announce themselves to a socket of their own process. Once the new participant is listening,
`passed_on` sends the announcement to the other participants.
"""

from __future__ import annotations

import os
import select
import socket
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

PORT = "GRADER_ANNOUNCEMENT_PORT"
"""The environment variable that the profiles loopback.xml and loopback_patient.xml read: the port to which a
participant announces itself, or 0 for the ports of all participants of the domain."""
_LARGEST = 1 << 16
_WAIT_S = 1.0


@contextmanager
def passed_on(domain: int) -> Iterator[None]:
    """A context in which the caller creates a participant.

    On exit from the context, the announcement is sent to all participants of the domain on this machine.
    """
    held = _held()
    list(_received(held))  # the announcements of earlier participants of this process
    yield
    select.select([held], [], [], _WAIT_S)
    announcements = list(_received(held))
    for port in participant_ports(domain):
        for announcement in announcements:
            with suppress(OSError):
                held.sendto(announcement, ("127.0.0.1", port))


def _received(held: socket.socket) -> Iterator[bytes]:
    with suppress(BlockingIOError):
        while True:
            yield held.recv(_LARGEST)


@cache
def _held() -> socket.socket:
    """Return the socket to which the participants of this process announce themselves.

    Fast DDS reads a profile only once in a process, so the socket stays open until the process exits.
    """
    held = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    held.bind(("127.0.0.1", 0))
    held.settimeout(0)
    os.environ[PORT] = str(held.getsockname()[1])
    return held


def participant_ports(domain: int) -> set[int]:
    """Return the ports on this machine on which participants of a domain receive announcements.

    The ports follow DDSI-RTPS, 9.6.1.1: metatraffic unicast = 7400 + 250 * domain + 10 + 2 * participant.
    """
    first = 7400 + 250 * domain
    # The last ports of domain 101 are in the range from which Linux assigns ports to any program.
    end = _first_assigned() if first < _first_assigned() < first + 250 else first + 250
    ports: set[int] = set()
    for table in ("/proc/net/udp", "/proc/net/udp6"):
        with suppress(OSError):
            rows = Path(table).read_text("ascii").splitlines()[1:]
            ports.update(int(row.split()[1].rpartition(":")[2], 16) for row in rows)
    return {port for port in ports if first + 10 <= port < end and port % 2 == 0}


@cache
def _first_assigned() -> int:
    """Return the first of the ports that Linux assigns to programs that do not choose a port."""
    try:
        return int(Path("/proc/sys/net/ipv4/ip_local_port_range").read_text("ascii").split()[0])
    except (OSError, ValueError, IndexError):
        return 32768
