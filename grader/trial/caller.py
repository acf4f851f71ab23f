"""Caller: the service calls that the trial itself makes at given times, and the responses of the node."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from grader.ros.message_values import fill, load_type, plain
from grader.trial.observed import Call

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.client import Client
    from rclpy.node import Node

    from grader.trial.inputs import PlannedCall

LATE_S = 1.0
"""The maximum time (s), on the trial's clock, to wait until the service of a call is available."""
FOUND_S = 0.5
"""The maximum wall time (s) to wait until a service is discovered, while simulated time stands still."""
ROUNDING_NS = 1000
"""The maximum error (ns) of the time of a request, which DDS does not store in nanoseconds."""


class Caller:
    """Makes each service call at the time that the exercise sets. A call waits up to LATE_S until its service is ready.

    During this wait, the later calls wait, too.

    The clients are created at the start, so that discovery is usually complete before the first call.

    Servers of `node` itself do not count: they are the silent servers (see SilentServers), which never respond.
    """

    def __init__(self, node: Node, calls: tuple[PlannedCall, ...], now: Callable[[], float]) -> None:
        self._node = node
        self._now = now
        self._waiting = [(call, self._client(call)) for call in sorted(calls, key=lambda call: call.at_s)]
        self._first_s: dict[int, float] = {}
        self._made: list[Call] = []
        self._sent: list[tuple[str, int, int]] = []
        """The requests that no silent server has received: the service, and the system time before and after (ns)."""

    @property
    def calls(self) -> tuple[Call, ...]:
        """The calls that were made so far, in order. A call is `missing` if its service was not ready in time."""
        return tuple(self._made)

    @property
    def pending(self) -> bool:
        """Whether a call is still waiting for its response."""
        return any(call.response is None and not call.missing for call in self._made)

    def sent(self, service: str, sent_ns: int) -> bool:
        """Return whether the request that a silent server received, sent at this system time (ns), is from the trial.

        A request also contains the id of its client, but rclpy does not provide it.
        """
        for each in self._sent:
            name, before_ns, after_ns = each
            if name == service and before_ns - ROUNDING_NS <= sent_ns <= after_ns + ROUNDING_NS:
                self._sent.remove(each)
                return True
        return False

    def make_due(self, now_s: float, *, spin: Callable[[float], object] | None) -> None:
        """Make the calls that are due.

        If the clock stands still during this method, `spin` must be a function that spins the node for a given time
        (s). Otherwise, `spin` is None.
        """
        while self._waiting and self._waiting[0][0].at_s <= now_s:
            call, client = self._waiting[0]
            if not self._is_ready(client) and not self._given_up(call, client, now_s, spin):
                return
            self._waiting.pop(0)
            self._make(call, client, now_s)

    def _given_up(
        self, call: PlannedCall, client: Client, now_s: float, spin: Callable[[float], object] | None
    ) -> bool:
        """Wait for the service. Return True if it is available or the maximum time has passed."""
        until = time.monotonic() + FOUND_S
        while spin is not None and id(call) not in self._first_s and time.monotonic() < until:
            spin(0.01)
            if self._is_ready(client):
                return True
        first_s = self._first_s.setdefault(id(call), now_s)
        return now_s - first_s >= LATE_S

    def _make(self, call: PlannedCall, client: Client, now_s: float) -> None:
        index = len(self._made)
        ready = self._is_ready(client)
        self._made.append(Call(now_s, call.service, call.type, call.request, by_trial=True, missing=not ready))
        if not ready:
            return

        def answered(future: Any) -> None:  # noqa: ANN401 - an rclpy future
            response = future.result()
            if response is not None:
                self._made[index] = self._made[index].answered(self._now(), plain(response))

        request = fill(client.srv_type.Request(), call.request)
        before_ns = time.time_ns()
        client.call_async(request).add_done_callback(answered)
        self._sent.append((call.service, before_ns, time.time_ns()))

    def _is_ready(self, client: Client) -> bool:
        silent = sum(service.srv_name == client.srv_name for service in self._node.services)
        return bool(client.service_is_ready() and self._node.count_services(client.srv_name) > silent)

    def _client(self, call: PlannedCall) -> Client:
        return self._node.create_client(load_type(call.type, "srv"), call.service)
