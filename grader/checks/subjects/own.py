"""Checks of the student's own numbers, which are in a file of the package, and of the movement that they require."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.kind import Kind, NoParams, number
from grader.checks.outcome import Finding, failed, passed
from grader.checks.own_values import drawn_numbers, numbers_spec, read_numbers
from grader.checks.subjects.path import CircleParams, circle, requested_circle
from grader.checks.subjects.rate import Rate, rate
from grader.common.words import shorten
from grader.exercise.own_numbers import draw_numbers, normal_id, without_surrogates
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.requested import Requested
    from grader.evidence.evidence import Evidence
    from grader.exercise.own_numbers import OwnNumbers

EARLY, LATE = 0.8, 1.3
"""The shortest and the longest allowed interval, as multiples of the period."""


def own_numbers(evidence: Evidence, _: NoParams) -> Finding:
    """The numbers exist, belong to the student named in the file and, in a class, were submitted by that student."""
    found = read_numbers(evidence)
    if isinstance(found, Finding):
        return found
    spec, by = numbers_spec(evidence), evidence.submission.student
    if by is not None and normal_id(found.student) != normal_id(without_surrogates(by)):
        observed = (
            f'The numbers in {spec.file} were assigned to "{shorten(found.student)}", '
            f'but "{shorten(by)}" submitted them.'
        )
        expected = "Every student has their own numbers."
        step = spec.step[:2]
        student = shlex.quote(shorten(by))
        command = f"`grader start {step} --student {student} --fresh`"
        cause = f"{command} draws your numbers and moves your work to another folder."
        return failed(observed, expected, Cause("numbers-of-another", cause, Where(spec.file)))
    wanted = draw_numbers(spec, found.student)
    if found != wanted:
        observed = f"The numbers in {spec.file} are not the ones that were assigned to this student."
        cause = "Do not change the file. Use the file's numbers in your node."
        return failed(observed, f"{_shown(wanted)}.", Cause("numbers-changed", cause, Where(spec.file)))
    return passed(f"{_shown(found)}.")


def _shown(numbers: OwnNumbers) -> str:
    return ", ".join(f"{name} = {value}" for name, value in numbers.values.items())


@dataclass(frozen=True, kw_only=True)
class OwnCircle:
    """Like the kind `circle`, but the radius and the direction are the student's own."""

    radius_tolerance_m: float = number(0.05, above=0, about="The maximum error in the radius.")
    centre_tolerance_m: float = number(0.05, above=0, about="The maximum error in the centre.")
    residual_m: float = number(
        0.02, above=0, about="The maximum deviation of the trajectory from the fitted circle (root mean square)."
    )
    turns: float = number(1.0, above=0, about="The minimum number of turns.")


def own_circle(evidence: Evidence, params: OwnCircle) -> Finding:
    """The turtle drives the student's own circle."""
    wanted = own_circle_params(evidence, params)
    return wanted if isinstance(wanted, Finding) else circle(evidence, wanted)


def own_circle_params(evidence: Evidence, params: OwnCircle) -> CircleParams | Finding:
    """Return the circle that this student must drive, or a failed finding if the numbers cannot be read."""
    own = drawn_numbers(evidence)
    if isinstance(own, Finding):
        return own
    return CircleParams(
        radius_m=float(own.values["radius_m"]),
        radius_tolerance_m=params.radius_tolerance_m,
        centre_tolerance_m=params.centre_tolerance_m,
        residual_m=params.residual_m,
        turns=params.turns,
        direction=str(own.values["direction"]),
    )


@dataclass(frozen=True, kw_only=True)
class OwnRate:
    """Like the kind `rate`, but the rate is the student's own."""

    tolerance_percent: float = number(5.0, above=0, at_most=100, about="The maximum error in the mean rate.")


def own_rate(evidence: Evidence, params: OwnRate) -> Finding:
    """The commands arrive at the student's own rate."""
    own = drawn_numbers(evidence)
    if isinstance(own, Finding):
        return own
    rate_hz = float(own.values["rate_hz"])
    wanted = Rate(
        rate_hz=rate_hz,
        tolerance_percent=params.tolerance_percent,
        min_interval_s=EARLY / rate_hz,
        max_interval_s=LATE / rate_hz,
        first_within_s=3.0,
    )
    return rate(evidence, wanted)


def _requested(evidence: Evidence, params: OwnCircle) -> Requested | None:
    """Return the student's own circle, or None if the numbers cannot be read."""
    own = own_circle_params(evidence, params)
    return requested_circle(evidence, own) if isinstance(own, CircleParams) else None


NUMBERS = Kind(
    "own_numbers",
    "source",
    "The numbers are your own",
    NoParams,
    own_numbers,
    about="The file named in `[numbers]` contains the numbers that belong to the student who is named in it. In a "
    "class, this student submitted the file.",
)
CIRCLE = Kind(
    "own_circle",
    "trial",
    "The turtle drives your own circle",
    OwnCircle,
    own_circle,
    about="This kind is like `circle`, but the radius and the direction are the student's own numbers.",
    drives=True,
    requested=_requested,
)
RATE = Kind(
    "own_rate",
    "trial",
    "Commands arrive at your own rate",
    OwnRate,
    own_rate,
    about="This kind is like `rate`, but the rate is the student's own number. Each interval may be 0.8 to 1.3 periods "
    "long.",
    drives=True,
)
