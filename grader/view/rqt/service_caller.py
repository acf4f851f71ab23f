"""Call services for the page of rqt: list the services, create requests, and return the responses."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from grader.graph.names import hidden
from grader.ros import message_values
from grader.ros.failure import Ros2Error
from grader.ros.rendering import to_yaml

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.node import Node

TIMEOUT_S = 5.0
"""The maximum total time for a service to appear and to respond (s)."""
MOST_WAITING = 20
"""The maximum number of pending calls."""
_EVERY_NODES = "rcl_interfaces/srv/"
"""The beginning of the types of the parameter services, which most nodes have. These services are listed last."""

Answer = dict[str, object]
"""The `id` of a call, whether there was a response (`ok`), and a `text`: the response as YAML, or the error message."""
Service = dict[str, str]
"""A service: its name, its type, and a request as YAML with the default values ("" if it has no fields, or if the type
is not installed)."""


@cache
def blank_request(type_name: str) -> str:
    """Return a request of this type as YAML with the default values.

    Return "" if the request has no fields, or if the type is not installed.
    """
    try:
        request = message_values.load_type(type_name, "srv", "service type").Request()
    except Ros2Error:
        return ""
    text = to_yaml(request).strip()
    return "" if text == "structure_needs_at_least_one_member: 0" else text


def services(node: Node) -> list[Service]:
    """Return the services that can be called. Hidden services, such as those of actions, are omitted."""
    found = [
        {"name": name, "type": types[0], "request": blank_request(types[0])}
        for name, types in node.get_service_names_and_types()
        if not hidden(name)
    ]
    return sorted(found, key=lambda service: (service["type"].startswith(_EVERY_NODES), service["name"]))


@dataclass
class _Call:
    """A call that is waiting for the service, or for its response if `future` is set."""

    id: str
    client: Any
    request: Any
    until_s: float
    future: Any = None


class ServiceCaller:
    """Calls services in the thread of the node. `tell` is called with the response to each call, or with an error.

    `check` must be called several times per second.
    """

    def __init__(self, node: Node, tell: Callable[[Answer], object]) -> None:
        self._node = node
        self._tell = tell
        self._waiting: list[_Call] = []

    def call(self, id_: str, name: str, type_name: str, text: str) -> None:
        """Call a service with a request as YAML."""
        if len(self._waiting) >= MOST_WAITING:
            self._refuse(id_, "Too many calls are waiting for a response.")
            return
        try:
            made = message_values.load_type(type_name, "srv", "service type")
            request = message_values.fill(made.Request(), message_values.parse(text))
            client = self._node.create_client(made, name)
        except Ros2Error as error:
            self._refuse(id_, str(error))
            return
        except Exception as error:  # rclpy raises various exceptions for an invalid name
            self._refuse(id_, str(error).splitlines()[0])
            return
        self._waiting.append(_Call(id_, client, request, time.monotonic() + TIMEOUT_S))
        self.check()

    def check(self) -> None:
        """Send the calls whose services are ready, and pass responses and time-outs to `tell`."""
        for each in list(self._waiting):
            if each.future is None and each.client.service_is_ready():
                each.future = each.client.call_async(each.request)
            if each.future is not None and each.future.done():
                self._end(each, to_yaml(each.future.result()).strip(), ok=True)
            elif time.monotonic() > each.until_s:
                why = "The service did not respond" if each.future is not None else "The service did not appear"
                self._end(each, f"{why} within {TIMEOUT_S:g} s.", ok=False)

    def _end(self, call: _Call, text: str, *, ok: bool) -> None:
        self._waiting.remove(call)
        self._node.destroy_client(call.client)
        self._tell({"id": call.id, "text": text, "ok": ok})

    def _refuse(self, id_: str, why: str) -> None:
        self._tell({"id": id_, "text": why, "ok": False})
