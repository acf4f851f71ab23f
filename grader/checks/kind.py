"""A kind is a type of check, with the parameters that exercise.toml may set.

A dataclass next to the check function defines the parameters of a kind. The functions `number`, `string`, `strings`,
`table` and `choice` create the fields of the dataclass with their defaults and allowed values. A new exercise that uses
only existing kinds needs no new code in the grader.
"""

# ruff: noqa: ANN401 (the functions below return what dataclasses.field returns)
from __future__ import annotations

import math
from dataclasses import MISSING, dataclass, field, fields
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from grader.checks.outcome import Finding
from grader.checks.own_values import with_own_values
from grader.common.words import a_list
from grader.exercise.kind_spec import Allowed

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from grader.checks.requested import Requested
    from grader.evidence.evidence import Evidence
    from grader.evidence.stage import Stage
    from grader.exercise.kind_spec import Param


@dataclass(frozen=True)
class NoParams:
    """An empty set of parameters, for kinds without parameters."""


P = TypeVar("P")


@dataclass(frozen=True)
class Kind(Generic[P]):
    """A type of check. `check` is a pure function: the same evidence and parameters give the same finding.

    `title` is the title that a student sees if exercise.toml sets no title. `about` describes the check for authors of
    exercises (docs/kinds.md). If `advice` is True, checks of this kind are worth no points, and never make a submission
    fail.
    """

    name: str
    stage: Stage
    title: str
    params: type[P]
    check: Callable[[Evidence, P], Finding]
    about: str
    advice: bool = False
    early: Callable[[Evidence, P], Finding | None] | None = None
    """For a check that needs a build or a trial: return a finding if the files alone show a failure, else None."""
    drives: bool = False
    """Whether a node must send velocity commands to the turtle to pass a check of this kind."""
    requested: Callable[[Evidence, P], Requested | None] | None = None
    """Return the requirements of the check as shapes and values, or None if they cannot be determined."""
    radius_m: Callable[[P], float] | None = None
    """Return the radius (m) of a circle that must fit on both sides of a randomly drawn start position."""

    def parameters(self) -> dict[str, Allowed]:
        """Return the name of every parameter with its allowed values."""
        return {each.name: each.metadata["allowed"] for each in fields(self.params)}  # type: ignore[arg-type]

    def defaults(self) -> dict[str, Param]:
        """Return the optional parameters with their default values."""
        return {each.name: each.default for each in fields(self.params) if each.default is not MISSING}  # type: ignore[arg-type]

    def judge(self, evidence: Evidence, values: Mapping[str, Param]) -> Finding:
        """Run the check with these parameter values (read from exercise.toml, with defaults filled in)."""
        params = self._params(evidence, values)
        return params if isinstance(params, Finding) else self.check(evidence, params)

    def judge_early(self, evidence: Evidence, values: Mapping[str, Param]) -> Finding | None:
        """Return the finding that is certain before any code of the submission runs, or None."""
        if self.stage == "source":
            return self.judge(evidence, values)
        params = self._params(evidence, values)
        return None if self.early is None or isinstance(params, Finding) else self.early(evidence, params)

    def request(self, evidence: Evidence, values: Mapping[str, Param]) -> Requested | None:
        """Return what a check with these parameter values requires, in a form that can be drawn, or None."""
        params = self._params(evidence, values)
        return None if self.requested is None or isinstance(params, Finding) else self.requested(evidence, params)

    def radius(self, evidence: Evidence, values: Mapping[str, Param]) -> float | None:
        """Return the radius (m) of a circle that must fit on both sides of a random start position, or None."""
        params = self._params(evidence, values)
        return None if self.radius_m is None or isinstance(params, Finding) else self.radius_m(params)

    def _params(self, evidence: Evidence, values: Mapping[str, Param]) -> P | Finding:
        """Return the parameters with the student's own values, or a failed finding if the values cannot be read."""
        filled = with_own_values(evidence, values)
        return filled if isinstance(filled, Finding) else self.params(**filled)


def number(
    default: float | None = None,
    *,
    about: str,
    above: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
) -> Any:
    """Create a field for a finite number. If the field has no default, exercise.toml must set it."""

    def accept(value: object) -> float | None:
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            return None
        out = (
            (above is not None and not value > above)
            or (at_least is not None and not value >= at_least)
            or (at_most is not None and not value <= at_most)
        )
        return None if out else float(value)

    if at_least is not None and at_most is not None:
        words = f"a number from {at_least:g} to {at_most:g}"
    else:
        named = (("above", above), ("that is at least", at_least), ("at most", at_most))
        words = f"a number {' and '.join(f'{each} {limit:g}' for each, limit in named if limit is not None)}".rstrip()
    return _field(Allowed(words, accept, about), MISSING if default is None else default)


def string(words: str = "a string", *, about: str, start: str = "", default: str | None = None) -> Any:
    """Create a field for a string that starts with `start` and is not blank.

    If the field has no default, exercise.toml must set it.
    """

    def accept(value: object) -> str | None:
        return value if isinstance(value, str) and value.strip() and value.startswith(start) else None

    return _field(
        Allowed(f"{words} starting with {start}" if start else words, accept, about),
        MISSING if default is None else default,
    )


def strings(*, about: str) -> Any:
    """Create a field for a list of at least one string. No string may be empty."""

    def accept(value: object) -> tuple[str, ...] | None:
        good = isinstance(value, list) and value and all(isinstance(item, str) and item for item in value)
        return tuple(value) if good else None  # type: ignore[arg-type]

    return _field(Allowed("a list of at least one string, and no empty strings", accept, about))


def table(*, about: str, optional: bool = False) -> Any:
    """Create a field for a table that is not empty. The field's value is a tuple of (name, value) pairs.

    If the field is optional, the default is an empty tuple.
    """

    def accept(value: object) -> tuple[tuple[str, Any], ...] | None:
        return tuple(value.items()) if isinstance(value, dict) and value else None

    return _field(Allowed("a table with at least one value", accept, about), () if optional else MISSING)


def choice(*options: str, about: str) -> Any:
    """Create a field for one of the options. The first option is the default."""

    def accept(value: object) -> str | None:
        return value if isinstance(value, str) and value in options else None

    return _field(Allowed(a_list([f'"{option}"' for option in options], "or"), accept, about), options[0])


def _field(allowed: Allowed, default: Any = MISSING) -> Any:
    if default is MISSING:
        return field(metadata={"allowed": allowed})
    return field(default=default, metadata={"allowed": allowed})
