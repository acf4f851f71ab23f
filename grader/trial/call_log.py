"""The service calls that nodes make to the nodes of the grader or to each other."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from grader.ros.message_values import plain
from grader.trial.observed import Call

if TYPE_CHECKING:
    from collections.abc import Callable

MOST_CALLS, MOST_ALIKE = 1000, 200
"""The log keeps the first MOST_CALLS calls. After that, a call is kept only if the log contains fewer than MOST_ALIKE
similar calls. Similar calls are calls to services whose names end in the same word, such as /turtle1/set_pen and
/turtle2/set_pen."""


class CallLog:
    """Records the calls, up to a limit. Thousands of calls to one service do not displace calls of another kind."""

    def __init__(self, now: Callable[[], float]) -> None:
        """Create an empty log. `now` returns the current time on the trial's clock (s)."""
        self._now = now
        self._calls: list[Call] = []
        self._alike: Counter[str] = Counter()

    @property
    def calls(self) -> tuple[Call, ...]:
        """The recorded calls. A call is added when the grader responds to it, or when SilentServers receives it."""
        return tuple(self._calls)

    def answered(self, service: str, type_name: str, request: Any, response: Any, waited_s: float) -> None:  # noqa: ANN401
        """Record a call to which the grader has responded, `waited_s` (s) after the call arrived."""
        if self._has_room(service):
            now_s = self._now()
            self._calls.append(Call(now_s - waited_s, service, type_name, plain(request), plain(response), now_s))

    def overheard(self, service: str, type_name: str, request: Any) -> None:  # noqa: ANN401 - a ROS message
        """Record a call between two nodes."""
        if self._has_room(service):
            self._calls.append(Call(self._now(), service, type_name, plain(request)))

    def _has_room(self, service: str) -> bool:
        name = service.rpartition("/")[2]
        if len(self._calls) >= MOST_CALLS and self._alike[name] >= MOST_ALIKE:
            return False
        self._alike[name] += 1
        return True
