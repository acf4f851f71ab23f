"""Exercise: what is to be done in a step, read from course/*/exercise.toml."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Mapping

Param = str | float | int | bool | tuple[str, ...]


@dataclass(frozen=True)
class CheckSpec:
    """One `[[check]]`: `params` hold its numbers, with units in their names (`rate_hz`, `radius_m`)."""

    id: str
    kind: str
    title: str
    points: float
    needs: tuple[str, ...]
    hidden: bool
    params: Mapping[str, Param]


@dataclass(frozen=True)
class Scenario:
    """What a trial does: `duration_s` on the trial's clock, then SIGINT."""

    duration_s: float


@dataclass(frozen=True)
class Exercise:
    """A step's exercise. `node` is the node's name without a slash, `executable` the entry point that starts it."""

    id: str
    title: str
    package: str
    executable: str
    node: str
    scenario: Scenario
    checks: tuple[CheckSpec, ...]
    hints: tuple[str, ...]
    folder: Path
