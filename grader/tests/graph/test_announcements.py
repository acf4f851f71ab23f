from __future__ import annotations

import os
import select
import socket
from contextlib import closing

import pytest

from grader.graph import announcements
from grader.graph.announcements import PORT, participant_ports, passed_on
from grader.tests.domains import own_domain
from grader.tests.waiting import HANG_S

PORTS_OF_A_DOMAIN = 250
OTHER, NEXT = 60, 100
"""The distances of ports from the first participant's port. No test has enough participants in a domain to use them."""


@pytest.fixture
def domain() -> int:
    """Return a domain whose ports no other process uses."""
    return own_domain()


def metatraffic(domain: int) -> int:
    """Return the port on which the first participant of a domain receives announcements."""
    return 7400 + PORTS_OF_A_DOMAIN * domain + 10


def listening(port: int) -> socket.socket:
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.bind(("127.0.0.1", port))
    made.settimeout(HANG_S)
    return made


def announce(text: bytes) -> None:
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as new:
        new.sendto(text, ("127.0.0.1", int(os.environ[PORT])))
    assert select.select([announcements._held()], [], [], HANG_S)[0]


def test_the_ports_of_participants_are_counted_and_no_others(domain: int) -> None:
    first = metatraffic(domain)
    before = participant_ports(domain)
    with (
        closing(listening(first + OTHER)),
        closing(listening(first + OTHER + 1)),  # user traffic of the same participant
        closing(listening(first + PORTS_OF_A_DOMAIN + NEXT)),  # the next domain
    ):
        assert participant_ports(domain) - before == {first + OTHER}


def test_a_port_that_linux_assigns_to_any_program_is_not_counted(domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Such ports are in domain 101, whose last 132 ports are above 32767."""
    first = metatraffic(domain)
    before = participant_ports(domain)
    with closing(listening(first + OTHER)), closing(listening(first + NEXT)):
        assert participant_ports(domain) - before == {first + OTHER, first + NEXT}
        monkeypatch.setattr(announcements, "_first_assigned", lambda: first + NEXT)
        assert participant_ports(domain) - before == {first + OTHER}
        # In a domain that the user has chosen in the middle of these ports, all of its ports are counted.
        monkeypatch.setattr(announcements, "_first_assigned", lambda: first - 10)
        assert participant_ports(domain) - before == {first + OTHER, first + NEXT}


def test_an_announcement_is_passed_on_only_when_the_participant_exists(domain: int) -> None:
    with closing(listening(metatraffic(domain) + OTHER)) as other:
        with passed_on(domain):
            announce(b"first")
            assert select.select([other], [], [], 0.0) == ([], [], [])
        assert other.recv(100) == b"first"


def test_an_old_announcement_is_not_passed_on(domain: int) -> None:
    with closing(listening(metatraffic(domain) + OTHER)) as other:
        with passed_on(domain):
            announce(b"old")
        announce(b"later, from a node that has ended")
        with passed_on(domain):
            announce(b"new")
        assert [other.recv(100), other.recv(100)] == [b"old", b"new"]
