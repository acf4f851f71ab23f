"""Check of the values in every command that arrived."""

from __future__ import annotations

import ast
import math
import re
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.line_of_value import line_of_value
from grader.checks.causes.why_not_set import compared_field
from grader.checks.edit import Edit, at
from grader.checks.kind import Kind, number
from grader.checks.outcome import Finding, failed, passed
from grader.checks.requested import Requested
from grader.checks.tolerance import Band
from grader.common.words import a_list
from grader.common.words import number as shown
from grader.trial.recording import FIELDS

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.checks.diagnosis import Diagnosis
    from grader.evidence.evidence import Evidence
    from grader.submission.where import Where

Six = tuple[float, ...]
"""The values of a command in the order of FIELDS: three in m/s, three in rad/s."""


@dataclass(frozen=True, kw_only=True)
class Values:
    """The values that each command must have. Fields that are not in the table must be 0."""

    linear_x_m_s: float = number(0.0, about="The value of linear.x in each command.")
    linear_y_m_s: float = number(0.0, about="The value of linear.y in each command.")
    linear_z_m_s: float = number(0.0, about="The value of linear.z in each command.")
    angular_x_rad_s: float = number(0.0, about="The value of angular.x in each command.")
    angular_y_rad_s: float = number(0.0, about="The value of angular.y in each command.")
    angular_z_rad_s: float = number(0.0, about="The value of angular.z in each command.")
    linear_tolerance_m_s: float = number(1e-6, above=0, about="The maximum error of a linear value.")
    angular_tolerance_rad_s: float = number(1e-6, above=0, about="The maximum error of an angular value.")

    @property
    def wanted(self) -> Six:
        """The six required values."""
        linear = (self.linear_x_m_s, self.linear_y_m_s, self.linear_z_m_s)
        return (*linear, self.angular_x_rad_s, self.angular_y_rad_s, self.angular_z_rad_s)

    @property
    def bands(self) -> tuple[Band, ...]:
        """The allowed range of each of the six values."""
        tolerances = [self.linear_tolerance_m_s] * 3 + [self.angular_tolerance_rad_s] * 3
        return tuple(Band.around(nominal, width) for nominal, width in zip(self.wanted, tolerances, strict=True))


def values(evidence: Evidence, params: Values) -> Finding:
    """Every command before SIGINT has the right value in all six fields."""
    bands = params.bands
    amounts = Counter(command.values for command in evidence.commands)
    near = any(band.near(value) for six in amounts for band, value in zip(bands, six, strict=True))
    expected = _expected(params.wanted)
    wrong = [six for six in amounts if not _all_hold(bands, six)]
    if not amounts:
        return failed("No command arrived.", expected, Cause("no-commands"))
    if not wrong:
        return passed(f"Every command has {expected[0].lower()}{expected[1:]}", near_edge=near)
    first = wrong[0]
    off = [index for index, band in enumerate(bands) if not band.holds(first[index])]
    actual = a_list([_field(index, shown(first[index], params.wanted[index])) for index in off])
    total, bad = sum(amounts.values()), sum(amounts[six] for six in wrong)
    amount = f"{bad} of {total} commands {'was' if bad == 1 else 'were'}"
    if bad == total:
        amount = "The only command was" if total == 1 else f"All {total} commands were"
    alike = len({str(six) for six in wrong}) == 1
    observed = f"{amount} wrong: {actual}{'' if alike else ' in the first of them'}."
    why, field = _why(first, params.wanted, off)
    if why.diagnosis == "wrong-value" and bad < total:
        why = Cause("values-change", "The other commands were right. Something changes the values while the node runs.")
    if why.diagnosis in ("wrong-value", "empty-twist") and bad == total:
        why = next(filter(None, (compared_field(evidence, FIELDS[index]) for index in off)), why)
    if why.diagnosis == "empty-twist":
        why = why.at(_published_empty(evidence))
    if bad == total and alike and why.diagnosis != "equals":
        why = why.fixed_by(_right_values(evidence, params.wanted, off))
    line = line_of_value(evidence, field, first[FIELDS.index(field)]) if why.diagnosis in OF_A_NUMBER else None
    return failed(observed, expected, why.at(line or _line(evidence, field)), near_edge=near)


def _expected(wanted: Six) -> str:
    right = a_list([_field(index, shown(value)) for index, value in enumerate(wanted) if value])
    return f"{right}, all other fields 0." if right else "All fields 0."


def _field(index: int, value: str) -> str:
    """Return a field with its value and unit."""
    return f"{FIELDS[index]} {value} {'m/s' if FIELDS[index].startswith('linear') else 'rad/s'}"


def _all_hold(bands: tuple[Band, ...], six: Six) -> bool:
    return all(band.holds(value) for band, value in zip(bands, six, strict=True))


def _right_values(evidence: Evidence, wanted: Six, off: list[int]) -> tuple[Edit, ...]:
    """Return edits that correct wrong fields. Each edit changes or inserts an assignment on a separate line.

    A field gets no edit if the source sets it in another way.
    """
    edits: list[Edit] = []
    sets: list[tuple[Where, str]] = []
    for index, field in enumerate(FIELDS):
        where = evidence.code.assigned(*field.split("."))
        line = _text(evidence, where)
        found = re.match(rf"\s*[\w.]*\b{re.escape(field)}\s*=\s*(?P<value>[^=#;]+?)\s*(?:#.*)?$", line)
        if where is not None and found is not None:
            sets.append((where, line[: line.index(field)]))
        if index in off and found is not None:
            edits += at(where, found["value"], str(wanted[index]))
        elif index in off and wanted[index] and sets and where is None:
            place, begin = sets[0]
            edits += at(place, "", f"{begin}{field} = {wanted[index]}")
    return tuple(edits)


def _text(evidence: Evidence, where: Where | None) -> str:
    if where is None or where.line is None:
        return ""
    lines = evidence.submission.files[where.file].decode("utf-8", "replace").splitlines()
    return lines[where.line - 1] if where.line <= len(lines) else ""


def _line(evidence: Evidence, field: str) -> Where | None:
    linear_or_angular, axis = field.split(".")
    return evidence.code.assigned(linear_or_angular, axis) or evidence.place("Twist")


def _published_empty(evidence: Evidence) -> Where | None:
    """Return the place where a new message is published without setting any of its fields, or None."""
    for call in evidence.code.calls("publish"):
        message = call.argument(0, "msg")
        if isinstance(message, ast.Call) and not message.args and not message.keywords:
            return call.where
    return None


def _same(value: float, other: float) -> bool:
    return math.isclose(value, other, rel_tol=1e-3)


def _why(six: Six, wanted: Six, off: list[int]) -> tuple[Cause, str]:
    """Return the cause of a wrong value, and the field that has the wrong value."""
    first = FIELDS[off[0]]
    not_numbers = [FIELDS[index] for index in off if not math.isfinite(six[index])]
    if not_numbers:
        return Cause(
            "not-a-number",
            "NaN or infinity may come from a calculation without a defined result, such as infinity minus infinity.",
        ), not_numbers[0]
    if not any(six):
        return Cause(
            "empty-twist", "All fields of a new Twist are 0. Set the fields before you publish the message."
        ), first
    if any(wanted) and _same(six[0], wanted[5]) and _same(six[5], wanted[0]) and not _same(wanted[0], wanted[5]):
        return Cause("values-swapped", "The forward speed and the turning speed are swapped."), "linear.x"
    for index in off:
        if wanted[index] and not six[index]:
            other = [each for each in off if _same(six[each], wanted[index]) and not wanted[each]]
            if other:
                cause = (
                    f"{FIELDS[other[0]]} has the value that belongs in {FIELDS[index]}: {_meaning(FIELDS[other[0]])}"
                )
                return Cause("wrong-field", cause), FIELDS[other[0]]
    return _scaled(six, wanted, off) or (Cause("wrong-value", MEANING), first)


OF_A_NUMBER = frozenset({"wrong-value", "wrong-sign", "degrees", "values-swapped"})
"""Diagnoses for which the student must change the number where it is written, for example in a function call."""
MEANING = "linear.x is the forward speed, and angular.z is how fast the turtle turns to the left."


def _meaning(field: str) -> str:
    if field in ("linear.y", "linear.z"):
        return "the turtle drives along linear.x only."
    return "the turtle turns about the z axis, which points up."


SCALES: tuple[tuple[Diagnosis, str, Callable[[float], float]], ...] = (
    ("wrong-sign", "The sign is wrong.", lambda value: -value),
    ("degrees", "Angles are in radians. This value looks like degrees.", math.degrees),
    (
        "degrees",
        "This value looks as if it had been converted from degrees to radians, but the number was already in radians.",
        math.radians,
    ),
)


def _scaled(six: Six, wanted: Six, off: list[int]) -> tuple[Cause, str] | None:
    for index in off:
        for diagnosis, cause, scale in SCALES:
            fits = wanted[index] != 0.0 and _same(six[index], scale(wanted[index]))
            if fits and (diagnosis != "degrees" or FIELDS[index].startswith("angular")):
                return Cause(diagnosis, cause), FIELDS[index]
    return None


def requested_values(_: Evidence, params: Values) -> Requested:
    """Return the six values that each command must have."""
    return Requested(values=params.wanted)


VALUES = Kind(
    "values",
    "trial",
    "The commands have the right values",
    Values,
    values,
    about="Each command has the given values; a value that is not given must be 0.",
    drives=True,
    requested=requested_values,
)
