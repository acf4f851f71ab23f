"""What the checks of a trial require, as shapes on the canvas and as limits in the charts.

Each kind of check describes its own requirements.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.kinds import KINDS
from grader.report.shapes import Line, Ring

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.requested import Interval, Requested
    from grader.evidence.evidence import Evidence


def requested(evidence: Evidence) -> Iterator[Requested]:
    """Yield the requirements that a drawing can show, in the order of this trial's checks, without hidden checks."""
    for spec in evidence.exercise.checks:
        if spec.trial == evidence.trial.id and not spec.hidden:
            found = KINDS[spec.kind].request(evidence, spec.params)
            if found is not None:
                yield found


def requested_path(evidence: Evidence) -> Requested | None:
    """Return the first required path, or None if no check requires one."""
    return next((each for each in requested(evidence) if each.path), None)


def requested_interval(evidence: Evidence) -> Interval | None:
    """Return the first required interval between two commands, or None if no check requires one."""
    return next((each.interval for each in requested(evidence) if each.interval is not None), None)


def requested_values(evidence: Evidence) -> tuple[float, ...] | None:
    """Return the first required values of the commands, or None if no check requires specific values."""
    return next((each.values for each in requested(evidence) if each.values is not None), None)


def shapes_of(path: Requested) -> tuple[Line | Ring, ...]:
    """Return the required path as shapes on the canvas."""
    rings = tuple(Ring("expected", centre, radius) for centre, radius in path.circles)
    return (*rings, *(Line("expected", points) for points in path.lines))


def must_drive(evidence: Evidence) -> bool:
    """Return whether any check of this trial requires the turtle to receive commands."""
    return any(KINDS[spec.kind].drives and spec.trial == evidence.trial.id for spec in evidence.exercise.checks)
