"""KindSpec: what a reader of exercise.toml must know about a kind of check, which is not how it judges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Param = str | float | int | bool | tuple[str, ...]
"""What a parameter of a check may be."""


@dataclass(frozen=True)
class Allowed:
    """What a parameter may be: in words, and as a function from the TOML value to ours (None: not allowed).

    `about` says what the parameter means, for the author of an exercise (docs/kinds.md).
    """

    words: str
    accept: Callable[[object], Param | None]
    about: str


class KindSpec(Protocol):
    """A kind of check, as exercise.toml sees it; `grader.checks.kind.Kind` is one."""

    @property
    def title(self) -> str:
        """The line that a student reads when exercise.toml gives none."""

    @property
    def advice(self) -> bool:
        """Whether its checks are worth no points and fail no run."""

    def parameters(self) -> Mapping[str, Allowed]:
        """Every parameter's name with what it may be."""

    def defaults(self) -> Mapping[str, Param]:
        """The parameters that may be left out, with their values."""
