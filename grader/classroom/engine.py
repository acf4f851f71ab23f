"""The interface of the engines that run tasks: local.py on this machine, dask_engine.py on many machines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from types import TracebackType

    from grader.classroom.task import Done, Task

TASK_S = 1800.0
"""A worker that is busy for longer than this (s) is considered hung."""


@dataclass(frozen=True)
class Progress:
    """The current stage of a task, as text."""

    task: Task
    text: str


@dataclass(frozen=True)
class Finished:
    """A completed task and its result."""

    task: Task
    done: Done


@dataclass(frozen=True)
class Died:
    """A task whose worker process exited, was stuck, or was lost with its machine."""

    task: Task
    why: str


Event = Progress | Finished | Died


class Engine(Protocol):
    """A context manager that runs tasks.

    Leaving the context stops all tasks.

        with engine:
            while engine.has_room():
                engine.start(task)
            for event in engine.events(0.5):
                ...
    """

    def __enter__(self) -> Engine:  # noqa: PYI034 - typing.Self is Python 3.11's
        ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None, /
    ) -> None: ...

    def has_room(self) -> bool:
        """Return whether another task can be started now."""

    def start(self, task: Task) -> None:
        """Start a task. Call this only if `has_room` is true."""

    def events(self, timeout_s: float) -> list[Event]:
        """Return the events since the last call. Wait at most `timeout_s` (s) for the first event.

        Raises:
            MachineError: no further submission can be graded.
        """
