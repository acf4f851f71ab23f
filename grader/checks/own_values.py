"""The student's own values in the parameters of a check."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.checks.cause import Cause
from grader.checks.outcome import Finding, failed
from grader.exercise.own_numbers import NumbersSpec, Own, OwnNumbers, draw_numbers, from_toml
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.evidence.evidence import Evidence


def numbers_spec(evidence: Evidence) -> NumbersSpec:
    """Return the table `[numbers]` of the exercise.

    An exercise without this table cannot have a check that needs the table.
    """
    assert evidence.exercise.numbers is not None
    return evidence.exercise.numbers


def read_numbers(evidence: Evidence) -> OwnNumbers | Finding:
    """Return the student's numbers from the submitted file, or a failed finding if the file is missing or invalid."""
    spec = numbers_spec(evidence)
    data = evidence.submission.files.get(spec.file)
    expected = f"{spec.file} is next to package.xml, as `grader start` wrote it."
    if data is None:
        return failed(f"There is no {spec.file}.", expected, Cause("no-numbers"))
    try:
        return from_toml(spec, data)
    except ValueError as error:
        return failed(f"{spec.file}: {error}.", expected, Cause("numbers-unreadable", where=Where(spec.file)))


def drawn_numbers(evidence: Evidence) -> OwnNumbers | Finding:
    """Return the numbers of the student whose id is in the file, or a failed finding if the file cannot be read.

    The numbers are calculated again from the student's id rather than read from the file.
    """
    found = read_numbers(evidence)
    return found if isinstance(found, Finding) else draw_numbers(numbers_spec(evidence), found.student)


def with_own_values(evidence: Evidence, values: Mapping[str, Any]) -> dict[str, Any] | Finding:
    """Return the parameters with the student's own values, or a failed finding if the numbers cannot be read."""
    if not any(_is_own(value) for value in values.values()):
        return dict(values)
    own = drawn_numbers(evidence)
    return own if isinstance(own, Finding) else {key: _filled(value, own) for key, value in values.items()}


def _is_own(value: object) -> bool:
    return isinstance(value, Own) or (isinstance(value, tuple) and any(_is_own(each) for each in value))


def _filled(value: Any, own: OwnNumbers) -> Any:  # noqa: ANN401 - a parameter, or a part of one
    if isinstance(value, Own):
        return own.values[value.name]
    return tuple(_filled(each, own) for each in value) if isinstance(value, tuple) else value
