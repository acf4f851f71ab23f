"""KindSpec: the part of a kind of check that is needed to read exercise.toml."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Param = str | float | int | bool | tuple[str, ...]
"""The types of a parameter of a check."""


@dataclass(frozen=True)
class Allowed:
    """The allowed values of a parameter, in words, and a function that converts the TOML value (None: not allowed).

    `about` tells the author of an exercise what the parameter means (docs/kinds.md).
    """

    words: str
    accept: Callable[[object], Param | None]
    about: str


class KindSpec(Protocol):
    """A kind of check, for the reader of exercise.toml; `grader.checks.kind.Kind` is one."""

    @property
    def title(self) -> str:
        """The title of the check if exercise.toml gives none."""

    @property
    def advice(self) -> bool:
        """Whether its checks are worth no points and never fail a submission."""

    def parameters(self) -> Mapping[str, Allowed]:
        """Return the names of all parameters with their allowed values."""

    def defaults(self) -> Mapping[str, Param]:
        """Return the optional parameters with their default values."""
