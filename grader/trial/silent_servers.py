"""Record the service calls between the nodes of a trial, with servers that receive each request and never respond.

In DDS, a request reaches every server of the service, and the client takes whichever response arrives.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.trial.interface_class import load_class

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from grader.trial.observed import Offer
    from grader.trial.recorder import Recorder

MOST_SERVICES = 20
"""The maximum number of services with a silent server. A node must not be able to fill the memory of the grader."""


class SilentServers:
    """Servers of the recorder, one for each service that a node of the submission offers, up to MOST_SERVICES.

    A silent server is created only after the node's own server has been discovered, so that a client does not find the
    silent server first.
    """

    def __init__(
        self,
        recorder: Recorder,
        prefixes: list[Path],
        on_request: Callable[[str, str, Any], object],
        is_by_trial: Callable[[str, int], bool],
    ) -> None:
        """Create the object without any servers.

        `on_request(service, type, request)` is called for each request that a node sent. The servers also receive the
        requests of the trial itself: for these, `is_by_trial(service, sent_ns)` must return True. `sent_ns` is the
        system time (ns) at which the request was sent.
        """
        self._recorder = recorder
        self._prefixes = prefixes
        self._on_request = on_request
        self._is_by_trial = is_by_trial
        self._known: set[str] = set()

    def follow(self) -> bool:
        """Create a server for each service that is new in the graph, and return whether any server was created."""
        self._recorder.follow_services()
        # Several nodes may offer the same service.
        fresh = {offer.service: offer for offer in self._recorder.offers if offer.service not in self._known}
        chosen = list(fresh.values())[: MOST_SERVICES - len(self._known)]
        self._known |= {offer.service for offer in chosen}
        served = [self._serve(offer) for offer in chosen]
        return any(served)

    def _serve(self, offer: Offer) -> bool:
        service_type = load_class(offer.type, "srv", self._prefixes)
        if service_type is None:
            return False

        def received(request: Any, header: Any) -> None:  # noqa: ANN401 - a ROS message and its header
            if not self._is_by_trial(offer.service, header.source_timestamp):
                self._on_request(offer.service, offer.type, request)

        # rclpy passes the header of the request only to `send_response`, with the result of the callback.
        service = self._recorder.create_service(service_type, offer.service, lambda request, _: request)
        service.send_response = received
        return True
