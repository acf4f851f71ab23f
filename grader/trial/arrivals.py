"""Take the messages that a subscription has received, or the requests to a service, without an executor.

An executor checks every entity and every event each time it runs, which takes longer than any other part of a frame.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.service import Service
    from rclpy.subscription import Subscription

MOST_AT_ONCE = 2000
"""The maximum number of messages or requests that are taken at once. The clock must advance even while very many
messages are arriving."""


def take_messages(subscription: Subscription) -> None:
    """Pass the messages that have arrived, at most MOST_AT_ONCE, to the subscription's callback."""
    with subscription.handle:
        for _ in range(MOST_AT_ONCE):
            taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
            if taken is None:
                break
            subscription.callback(taken[0])


def take_requests(service: Service) -> int:
    """Call the service's callback for the requests that have arrived, at most MOST_AT_ONCE. Return their number."""
    with service.handle:
        for count in range(MOST_AT_ONCE):
            request, header = service.handle.service_take_request(service.srv_type.Request)
            if header is None:
                return count
            service.send_response(service.callback(request, service.srv_type.Response()), header)
    return MOST_AT_ONCE
