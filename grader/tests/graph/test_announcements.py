from __future__ import annotations

import os
import socket
from contextlib import closing

import pytest

from grader.graph.announcements import PORT, participant_ports, passed_on

DOMAIN = 101
"""The highest domain that the course uses, so its ports are free."""
METATRAFFIC = 7400 + 250 * DOMAIN + 10


def listening(port: int) -> socket.socket:
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.bind(("127.0.0.1", port))
    made.settimeout(0)
    return made


def announce(text: bytes) -> None:
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as new:
        new.sendto(text, ("127.0.0.1", int(os.environ[PORT])))


def test_the_ports_of_participants_are_counted_and_no_others() -> None:
    before = participant_ports(DOMAIN)
    with (
        closing(listening(METATRAFFIC + 60)),
        closing(listening(METATRAFFIC + 61)),  # user traffic of the same participant
        closing(listening(METATRAFFIC + 250)),  # the next domain
    ):
        assert participant_ports(DOMAIN) - before == {METATRAFFIC + 60}


def test_an_announcement_is_passed_on_only_when_the_participant_exists() -> None:
    with closing(listening(METATRAFFIC + 60)) as other:
        with passed_on(DOMAIN):
            announce(b"first")
            with pytest.raises(BlockingIOError):
                other.recv(100)
        assert other.recv(100) == b"first"


def test_an_old_announcement_is_not_passed_on() -> None:
    with closing(listening(METATRAFFIC + 60)) as other:
        with passed_on(DOMAIN):
            announce(b"old")
        announce(b"later, from a node that has ended")
        with passed_on(DOMAIN):
            announce(b"new")
        assert [other.recv(100), other.recv(100)] == [b"old", b"new"]
