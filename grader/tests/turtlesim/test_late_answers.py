"""If the simulator answers late, a call takes effect only when it is answered. The calls are answered in order."""

from __future__ import annotations

from typing import Any

from grader.turtlesim.late_answers import LateAnswers


class Service:
    """The parts of an rclpy service that an executor uses."""

    class srv_type:  # noqa: N801 - as in rclpy
        """A service type whose responses are lists."""

        Response = list

    def __init__(self) -> None:
        self.callback: Any = None
        self.sent: list[tuple[object, object]] = []

    def send_response(self, response: object, header: object) -> None:
        self.sent.append((response, header))

    def call(self, request: object, header: object) -> None:
        self.send_response(self.callback(request, self.srv_type.Response()), header)


def test_calls_take_effect_and_are_answered_late_and_in_order() -> None:
    late, service, handled = LateAnswers(0.3), Service(), []

    def handle(request: str, response: list[str], waited_s: float) -> list[str]:
        handled.append((request, round(waited_s, 3)))
        return [*response, request]

    late.delay(service, handle)
    late.tick(1.0)
    service.call("first", 1)
    late.tick(1.1)
    service.call("second", 2)
    late.tick(1.2)
    assert (service.sent, handled) == ([], [])
    late.tick(1.31)
    assert (service.sent, handled) == ([(["first"], 1)], [("first", 0.31)])
    late.tick(1.5)
    assert service.sent[1:] == [(["second"], 2)]
