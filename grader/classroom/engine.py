"""What runs tasks: processes of this machine (local.py), or Dask's workers on many (dask_engine.py)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from types import TracebackType

    from grader.classroom.task import Done, Task


@dataclass(frozen=True)
class Tells:
    """What is being done with a task."""

    task: Task
    text: str


@dataclass(frozen=True)
class Finished:
    """A task is done."""

    task: Task
    done: Done


@dataclass(frozen=True)
class Died:
    """The worker that had the task is gone: killed, out of memory, or a machine that went away."""

    task: Task
    why: str


Event = Tells | Finished | Died


class Engine(Protocol):
    """A context manager; leaving it ends all that runs."""

    def __enter__(self) -> Engine:  # noqa: PYI034 - typing.Self is Python 3.11's
        ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None, /
    ) -> None: ...

    def has_room(self) -> bool:
        """Whether one more task may be started now."""

    def start(self, task: Task) -> None:
        """Begin a task, where there is room."""

    def events(self, timeout_s: float) -> list[Event]:
        """What has happened since the last call; waits for something, but no longer than that.

        Raises:
            MachineError: nothing can be graded any more, whatever the submission.
        """
