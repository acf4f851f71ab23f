"""What one run of `grader grade` has to do: which submissions to grade, and which earlier results are still valid."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from grader.checks.exercises import exercise_from
from grader.checks.outcome import Status
from grader.classroom.content import content_of, fingerprint
from grader.classroom.key import Key, changed, grader_key
from grader.classroom.refused import Refused
from grader.classroom.task import Task
from grader.exercise.own_numbers import normal_id
from grader.exercise.private_checks import sources_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from grader.classroom.found import Found
    from grader.classroom.results import Result, Results
    from grader.exercise.model import Exercise
    from grader.exercise.private_checks import Sources
    from grader.grading.clock import ClockChoice


@dataclass(frozen=True)
class Order:
    """The submissions of a class and the options. `roster` maps the normal form of a name to a student id."""

    found: tuple[Found, ...]
    roster: Mapping[str, str]
    sources: Mapping[str, Sources]
    ros: str
    clock: ClockChoice = "auto"
    seed: int | None = None
    explain: bool = True
    """Whether the grader tests likely causes by fixing them in a copy of the submission."""
    in_cell: bool = True
    """Whether submissions always run in a sandbox. This is False only for trusted submissions, if the machine has no
    sandbox or if Dask is used."""
    trusted: bool = False

    @cached_property
    def exercises(self) -> dict[str, Exercise]:
        """The exercises by id. Raises UsageError if the private checks of an exercise are not valid."""
        return {name: exercise_from(sources) for name, sources in self.sources.items()}

    def key(self, found: Found, task: Task | None = None) -> Key:
        """Return the key of a submission's result, or of the result of this task. Raises DiskError, as `read` does."""
        exercise = self.exercises[found.exercise]
        return Key(
            submission=fingerprint(found, exercise, task),
            student=self._owner(found),
            exercise=exercise.digest,
            grader=grader_key(),
            ros=self.ros,
            options=f"clock {self.clock}, seed {self.seed}, {'confined' if self.in_cell else 'not confined'}"
            + ("" if self.explain else ", not explained"),
        )

    def task(self, found: Found) -> Task:
        """Read the submission and return its task. Raises DiskError, as `content.read` does."""
        owner = self._owner(found)
        whole = content_of(found, self.exercises[found.exercise], owner)
        content = whole.handed_in
        if isinstance(content, Refused):
            return self._task(found, owner, content, archive=whole.archive)
        return self._task(
            found,
            owner,
            dict(content.files),
            archive=whole.archive,
            package=content.package_dir.name,
            rejected=content.rejected,
            digest=content.digest,
            executable=content.executable,
            remark=content.remark,
        )

    def _task(
        self,
        found: Found,
        owner: str,
        content: dict[str, bytes] | Refused,
        *,
        archive: str = "",
        package: str = "",
        rejected: tuple[str, ...] = (),
        digest: str = "",
        executable: frozenset[str] = frozenset(),
        remark: str = "",
    ) -> Task:
        return Task(
            student=found.student,
            owner=owner,
            sources=self.sources[found.exercise],
            content=content,
            archive=archive,
            package=package,
            rejected=rejected,
            digest=digest,
            executable=executable,
            remark=remark,
            clock=self.clock,
            seed=self.seed,
            explain=self.explain,
            trusted=self.trusted,
            grader=grader_key(),
            alike=found.alike,
        )

    def _owner(self, found: Found) -> str:
        return self.roster.get(normal_id(found.student), found.student)


def sources_for(found: tuple[Found, ...], checks: Path | None) -> dict[str, Sources]:
    """Return the files that define the exercises of these submissions. Raises UsageError, as `sources_of` does."""
    return sources_of({each.exercise for each in found}, checks)


@dataclass(frozen=True)
class Todo:
    """A submission that must be graded. `why` is a short reason, such as "new" or "changed"."""

    found: Found
    key: Key
    why: str
    errors: int = 0
    """How many times in a row grading the submission has ended with an `error`."""


def sort_out(order: Order, results: Results) -> tuple[list[Result], list[Todo]]:
    """Return the valid results, and the submissions to grade. Raises DiskError, as `content.read` does."""
    kept: list[Result] = []
    todo: list[Todo] = []
    for found in order.found:
        key = order.key(found)
        old = results.load(found.student, found.exercise)
        why = "new" if old is None else _why_again(old, key)
        if old is None or why:
            todo.append(Todo(found, key, why, old.errors if old else 0))
        else:
            kept.append(old)
    return kept, todo


def _why_again(old: Result, key: Key) -> str:
    parts = changed(old.key, key)
    # Another version may have computed the other values of the key differently.
    if "grader" in parts:
        return "graded by another version of the grader"
    if "submission" in parts or "student" in parts:
        return "changed"
    if "exercise" in parts:
        return "judged with different checks"
    if "ros" in parts:
        return "graded with another ROS 2"
    if parts:
        return "graded with different options"
    return "not judged last time" if old.report.with_status(Status.ERROR) else ""
