"""Kind: a sort of check, with the parameters that exercise.toml may give it.

The parameters of a kind are a dataclass beside the check; the functions `number`, `text`, `texts` and `choice` make its
fields, so that name, default and what is allowed stand in one place and a new exercise needs no Python.
"""

# ruff: noqa: ANN401 (the functions below return what dataclasses.field returns)
from __future__ import annotations

import math
from dataclasses import MISSING, dataclass, field, fields
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from grader.common.words import a_list
from grader.exercise.kind_spec import Allowed

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence
    from grader.evidence.stage import Stage
    from grader.exercise.kind_spec import Param


@dataclass(frozen=True)
class NoParams:
    """Parameters of a kind that has none."""


P = TypeVar("P")


@dataclass(frozen=True)
class Kind(Generic[P]):
    """A sort of check. `check` is pure: the same evidence and parameters give the same finding.

    `title` is the line a student reads when exercise.toml gives none. `about` says to the author of an exercise what is
    checked (docs/kinds.md). `advice`: worth no points, fails no run.
    """

    name: str
    stage: Stage
    title: str
    params: type[P]
    check: Callable[[Evidence, P], Finding]
    about: str
    advice: bool = False
    early: Callable[[Evidence, P], Finding | None] | None = None
    """What the files alone tell of a check that needs more: a failed finding that stands whatever comes, else None."""

    def parameters(self) -> dict[str, Allowed]:
        """Every parameter's name with what it may be."""
        return {each.name: each.metadata["allowed"] for each in fields(self.params)}  # type: ignore[arg-type]

    def defaults(self) -> dict[str, Param]:
        """The parameters that may be left out, with their values."""
        return {each.name: each.default for each in fields(self.params) if each.default is not MISSING}  # type: ignore[arg-type]

    def judge(self, evidence: Evidence, values: Mapping[str, Param]) -> Finding:
        """What the check finds with these parameter values (as read from exercise.toml, defaults filled in)."""
        return self.check(evidence, self.params(**values))

    def judge_early(self, evidence: Evidence, values: Mapping[str, Param]) -> Finding | None:
        """What is certain before anything of the submission's has run."""
        if self.stage == "source":
            return self.judge(evidence, values)
        return self.early(evidence, self.params(**values)) if self.early is not None else None


def number(
    default: float | None = None,
    *,
    about: str,
    above: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
) -> Any:
    """A finite number; without a default it must be given."""

    def accept(value: object) -> float | None:
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            return None
        out = (
            (above is not None and not value > above)
            or (at_least is not None and not value >= at_least)
            or (at_most is not None and not value <= at_most)
        )
        return None if out else float(value)

    limits = [
        f"{words} {limit:g}"
        for words, limit in (("above", above), ("at least", at_least), ("at most", at_most))
        if limit is not None
    ]
    words = f"a number {' and '.join(limits)}".rstrip()
    return _field(Allowed(words, accept, about), MISSING if default is None else default)


def text(words: str = "a text", *, about: str, start: str = "", default: str | None = None) -> Any:
    """A text that is not empty and begins with `start`; without a default it must be given."""

    def accept(value: object) -> str | None:
        return value if isinstance(value, str) and value.strip() and value.startswith(start) else None

    return _field(
        Allowed(f"{words} beginning with {start}" if start else words, accept, about),
        MISSING if default is None else default,
    )


def texts(*, about: str) -> Any:
    """A list of at least one text."""

    def accept(value: object) -> tuple[str, ...] | None:
        good = isinstance(value, list) and value and all(isinstance(item, str) and item for item in value)
        return tuple(value) if good else None  # type: ignore[arg-type]

    return _field(Allowed("a list of texts, at least one", accept, about))


def choice(*options: str, about: str) -> Any:
    """One of the options; the first is the default."""

    def accept(value: object) -> str | None:
        return value if isinstance(value, str) and value in options else None

    return _field(Allowed(a_list([f'"{option}"' for option in options], "or"), accept, about), options[0])


def _field(allowed: Allowed, default: Any = MISSING) -> Any:
    if default is MISSING:
        return field(metadata={"allowed": allowed})
    return field(default=default, metadata={"allowed": allowed})
