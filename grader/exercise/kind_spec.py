"""KindSpec: the part of a kind of check that reading exercise.toml uses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from grader.exercise.own_numbers import Own

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Param = str | float | int | bool | Own | tuple[Any, ...]
"""The possible types of a check's parameter. A tuple contains strings or pairs. A pair is a name, for example of a
message field, and its value."""


@dataclass(frozen=True)
class Allowed:
    """The allowed values of a parameter, in words, and a function that converts a TOML value.

    `accept` returns None if the value is not allowed. `about` describes the parameter in docs/kinds.md.
    """

    words: str
    accept: Callable[[object], Param | None]
    about: str


class KindSpec(Protocol):
    """The part of a kind of check that reading exercise.toml uses. `grader.checks.kind.Kind` implements it."""

    @property
    def title(self) -> str:
        """The title of the check if exercise.toml does not set one."""

    @property
    def advice(self) -> bool:
        """Whether checks of this kind are worth no points and never fail a submission."""

    def parameters(self) -> Mapping[str, Allowed] | None:
        """Return the allowed values of each parameter by name, or None in an outline, where no parameter is read."""

    def defaults(self) -> Mapping[str, Param]:
        """Return the default value of each optional parameter by name."""
