"""Respond to service calls late, so that a node that does not wait for a response fails visibly."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.service import Service


class LateAnswers:
    """Handles each call and responds to it in the first `tick` that is at least `after_s` (s) later than the request.

    `tick` sets the time, on the caller's clock. The responses are sent in the order in which the calls arrived.
    """

    def __init__(self, after_s: float) -> None:
        self._after_s = after_s
        self._now_s = 0.0
        self._waiting: deque[tuple[float, Callable[[float], None]]] = deque()

    def delay(self, service: Service, handle: Callable[[Any, Any, float], Any]) -> None:
        """When a response of the service is due, call `handle(request, response, waited_s)` and send the response."""
        answer, empty = service.send_response, service.srv_type.Response
        taken: list[Any] = []

        def take(request: Any, response: Any) -> Any:  # noqa: ANN401
            taken.append(request)
            return response

        def later(_: Any, header: Any) -> None:  # noqa: ANN401
            request = taken.pop()
            self._waiting.append((self._now_s, lambda waited_s: answer(handle(request, empty(), waited_s), header)))

        service.callback, service.send_response = take, later

    def tick(self, now_s: float) -> None:
        """Send the responses that are due at `now_s` (s)."""
        self._now_s = now_s
        while self._waiting and now_s - self._waiting[0][0] >= self._after_s:
            asked_s, answer = self._waiting.popleft()
            answer(now_s - asked_s)
