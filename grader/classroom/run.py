"""Run: grade what is to be graded, whatever happens to the processes that do it."""

from __future__ import annotations

from collections import Counter, deque
from typing import TYPE_CHECKING

from grader.classroom.engine import Died, Finished, Tells
from grader.classroom.task import set_aside

if TYPE_CHECKING:
    from grader.classroom.engine import Engine
    from grader.classroom.order import Order, Todo
    from grader.classroom.results import Result, Results
    from grader.classroom.show import Screen
    from grader.classroom.task import Done, Task

TRIES = 2
"""How many workers a submission may take with it before it is set aside."""
LOOK_S = 0.5
"""How long an engine may wait for something to happen."""


def run(order: Order, todo: list[Todo], engine: Engine, results: Results, screen: Screen) -> list[Result]:
    """Grade and write each result as it comes, in no order.

    Raises:
        MachineError: nothing more can be graded or written; what was written stays.
    """
    waiting = deque(todo)
    running: dict[tuple[str, str], Todo] = {}
    deaths: Counter[tuple[str, str]] = Counter()
    results_now: list[Result] = []

    def keep(task: Task, done: Done) -> None:
        one = running.pop(task.name)
        result = results.save(one.found.student, done.report, one.key, done.page)
        results_now.append(result)
        screen.finished(result)

    with engine:
        while waiting or running:
            while waiting and engine.has_room():
                one = waiting.popleft()
                task = order.task(one.found)
                running[task.name] = one
                screen.tells(task.name, "Starting")
                engine.start(task)
            for event in engine.events(LOOK_S):
                if isinstance(event, Tells):
                    screen.tells(event.task.name, event.text)
                elif isinstance(event, Finished):
                    keep(event.task, event.done)
                elif isinstance(event, Died):
                    deaths[event.task.name] += 1
                    if deaths[event.task.name] < TRIES:
                        screen.tells(event.task.name, "Its worker was lost: once more, later")
                        waiting.append(running.pop(event.task.name))
                    else:
                        keep(event.task, set_aside(event.task, _told(event.why)))
    return results_now


def _told(why: str) -> str:
    return (
        f"The grader's own process was lost twice while it had this submission ({why}). It is set aside; nothing is "
        "said of its quality. Look at it by itself with `grader check`, or run the same command again."
    )
