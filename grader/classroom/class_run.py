"""Grade all submissions of an `Order`, even if worker processes die."""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from grader.checks.outcome import Status
from grader.classroom.engine import Finished, Progress
from grader.classroom.task import set_aside

if TYPE_CHECKING:
    from grader.checks.outcome import Outcome
    from grader.classroom.engine import Engine, Event
    from grader.classroom.order import Order, Todo
    from grader.classroom.progress_display import Name, Screen
    from grader.classroom.results import Result, Results
    from grader.classroom.task import Done

TRIES = 2
"""How many times a submission may kill its worker or end with an `error` before its result is final."""
LOOK_S = 0.5
"""The maximum time to wait for events from the engine (s)."""


def run(order: Order, todo: list[Todo], engine: Engine, results: Results, screen: Screen) -> list[Result]:
    """Grade the submissions and write each result as soon as it is ready, in any order.

    Submissions that end with an `error` are graded once more at the end if at least one other submission has a final
    result. In this case, the machine works, so the error occurred by chance or was caused by the submission.

    Raises:
        MachineError: the machine can no longer grade submissions or write results. The results so far are kept.
    """
    one = _Run(order, deque(todo), engine, results, screen)
    with engine:
        while one.goes_on():
            one.start()
            for event in engine.events(LOOK_S):
                one.hear(event)
    return list(one.graded.values())


@dataclass
class _Run:
    order: Order
    waiting: deque[Todo]
    engine: Engine
    results: Results
    screen: Screen
    running: dict[Name, Todo] = field(default_factory=dict)
    again: dict[Name, Todo] = field(default_factory=dict)
    """The submissions that ended with an `error`. If not all submissions ended so, these are graded once more."""
    failures: Counter[Name] = field(default_factory=Counter)
    graded: dict[Name, Result] = field(default_factory=dict)
    outcomes: dict[Outcome, Outcome] = field(default_factory=dict)
    """Every outcome that occurs in a report. Equal outcomes of a large class are stored once."""

    def goes_on(self) -> bool:
        """Return whether any submission still has to be graded. Submissions that ended with an `error` come last."""
        if not self.waiting and not self.running and self.again:
            if len(self.again) < len(self.graded):
                self.waiting.extend(self.again.values())
            else:
                # No submission has a final result, so the machine would probably fail again.
                for name in self.again:
                    self.screen.finished(self.graded[name])
            self.again.clear()
        return bool(self.waiting or self.running)

    def start(self) -> None:
        """Start as many tasks as the engine has room for."""
        while self.waiting and self.engine.has_room():
            one = self.waiting.popleft()
            task = self.order.task(one.found)
            # The student may have changed the submission since its key was made. The key must be that of the graded
            # files, or a later run would take the result for the result of other files.
            self.running[task.name] = replace(one, key=self.order.key(one.found, task))
            self.screen.show(task.name, "Starting")
            self.engine.start(task)

    def hear(self, event: Event) -> None:
        """Handle an event from the engine."""
        name = event.task.name
        if isinstance(event, Progress):
            self.screen.show(name, event.text)
        elif isinstance(event, Finished):
            self._keep(name, event.done)
        elif self.failures[name] + 1 < TRIES:
            self.failures[name] += 1
            self.screen.show(name, "The worker was lost. The submission will be graded again later")
            self.waiting.append(self.running.pop(name))
        else:
            self._keep(name, set_aside(event.task, _in_words(event.why)))

    def _keep(self, name: Name, done: Done) -> None:
        one = self.running.pop(name)
        broken = bool(done.report.with_status(Status.ERROR))
        self.failures[name] += broken
        errors = one.errors + self.failures[name] if broken else 0
        result = self.results.save(one.found.student, done.report, one.key, done.page, errors)
        shared = tuple(self.outcomes.setdefault(outcome, outcome) for outcome in done.report.outcomes)
        self.graded[name] = result = replace(result, report=replace(result.report, outcomes=shared))
        if broken and self.failures[name] < TRIES:
            self.again[name] = one
            self.screen.show(name, "The submission could not be judged. It may be graded again later")
        else:
            self.screen.finished(result)


def _in_words(why: str) -> str:
    return (
        f"The grader's process was lost while it was grading this submission ({why}). The submission gets the status "
        "error, which says nothing about the quality of the submission. Grade the submission alone with "
        "`grader check`, or run the same command again."
    )
