"""The silent servers that record the calls between the nodes of a trial."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from grader.trial import silent_servers
from grader.trial.observed import Offer
from grader.trial.silent_servers import MOST_SERVICES, SilentServers

if TYPE_CHECKING:
    import pytest

TRIGGER = "std_srvs/srv/Trigger"


class Recorder:
    """A stand-in that stores the names of the services with a server."""

    def __init__(self, *offers: Offer) -> None:
        self.offers = offers
        self.served: list[str] = []

    def follow_services(self) -> None:
        """Find nothing new."""

    def create_service(self, _type: object, name: str, _callback: object) -> SimpleNamespace:
        """Create a service without ROS 2."""
        self.served.append(name)
        return SimpleNamespace()


def follow(monkeypatch: pytest.MonkeyPatch, *offers: Offer) -> list[str]:
    """Return the services that get a silent server if nodes offer these services."""
    monkeypatch.setattr(silent_servers, "load_class", lambda *_: object())
    recorder: Any = Recorder(*offers)
    servers = SilentServers(recorder, [], lambda *_: None, lambda *_: False)
    assert servers.follow()
    assert not servers.follow()
    return list(recorder.served)


def test_a_service_that_two_nodes_offer_has_one_silent_server(monkeypatch: pytest.MonkeyPatch) -> None:
    offers = [Offer(node, "/stop", TRIGGER) for node in ("/first", "/second")]
    assert follow(monkeypatch, *offers, Offer("/first", "/start", TRIGGER)) == ["/stop", "/start"]


def test_the_number_of_silent_servers_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    offers = [Offer("/node", f"/service{number}", TRIGGER) for number in range(2 * MOST_SERVICES)]
    assert len(follow(monkeypatch, *offers)) == MOST_SERVICES
