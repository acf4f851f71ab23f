"""What the checks of a trial ask for, as shapes on the canvas and limits in the charts; each kind says so itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.kinds import KINDS
from grader.report.shapes import Line, Ring

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.requested import Interval, Requested
    from grader.evidence.evidence import Evidence


def requested(evidence: Evidence) -> Iterator[Requested]:
    """What each check of this trial asks for that is not hidden, in the order of the exercise."""
    for spec in evidence.exercise.checks:
        if spec.trial == evidence.trial.id and not spec.hidden:
            found = KINDS[spec.kind].request(evidence, spec.params)
            if found is not None:
                yield found


def requested_path(evidence: Evidence) -> Requested | None:
    """The first path that is asked for; None where the turtle may drive as it likes."""
    return next((each for each in requested(evidence) if each.path), None)


def requested_interval(evidence: Evidence) -> Interval | None:
    """The interval between two commands that is asked for first; None where it is free."""
    return next((each.interval for each in requested(evidence) if each.interval is not None), None)


def requested_values(evidence: Evidence) -> tuple[float, ...] | None:
    """The values of each command that are asked for first; None where they are free."""
    return next((each.values for each in requested(evidence) if each.values is not None), None)


def shapes_of(path: Requested) -> tuple[Line | Ring, ...]:
    """The path as shapes on the canvas."""
    rings = tuple(Ring("expected", centre, radius) for centre, radius in path.circles)
    return (*rings, *(Line("expected", points) for points in path.lines))


def must_drive(evidence: Evidence) -> bool:
    """Whether some check of this trial needs commands to the turtle."""
    return any(KINDS[spec.kind].drives and spec.trial == evidence.trial.id for spec in evidence.exercise.checks)
