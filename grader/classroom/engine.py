"""An engine runs tasks: in processes on this machine (local.py), or with Dask on many machines (dask_engine.py)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from types import TracebackType

    from grader.classroom.task import Done, Task


@dataclass(frozen=True)
class Progress:
    """The current state of a task, in words."""

    task: Task
    text: str


@dataclass(frozen=True)
class Finished:
    """A task is done."""

    task: Task
    done: Done


@dataclass(frozen=True)
class Died:
    """The worker of a task is gone: it was killed, it ran out of memory, or its machine was lost."""

    task: Task
    why: str


Event = Progress | Finished | Died


class Engine(Protocol):
    """A context manager that runs tasks. Leaving the context stops all of them.

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
        """Start a task. Call this only if there is room."""

    def events(self, timeout_s: float) -> list[Event]:
        """Return what has happened since the last call. Wait at most `timeout_s` for something to happen.

        Raises:
            MachineError: this machine can no longer grade any submission.
        """
