"""Calls in the thread of an rclpy executor, in the order in which they were requested."""

from __future__ import annotations

from collections import deque
from inspect import isawaitable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.executors import Executor


class InOrder:
    """A queue of calls. Each call begins after all earlier calls have begun.

    If several tasks are waiting, rclpy's executor starts the newest one first (`Executor._wait_for_ready_callbacks`
    iterates over the reversed list). On a busy machine, a turtle then drove on after its key was released, because
    the command to stop was sent before the last command to drive. So each task takes the oldest call from this queue.
    """

    def __init__(self, executor: Executor) -> None:
        self._executor = executor
        self._calls: deque[tuple[Callable[..., object], tuple[object, ...]]] = deque()

    def call(self, function: Callable[..., object], *arguments: object) -> None:
        """Call the function later. If it returns an awaitable, await it. Any thread may call this method."""
        self._calls.append((function, arguments))
        self._executor.create_task(self._next)

    async def _next(self) -> None:
        function, arguments = self._calls.popleft()
        made = function(*arguments)
        if isawaitable(made):
            await made
