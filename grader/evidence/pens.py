"""The pens of a turtle, and the period in which the turtle had each pen."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.turtlesim.turtle import Pen

if TYPE_CHECKING:
    from grader.trial.recording import Recording


@dataclass(frozen=True)
class PenSpan:
    """A period, from `from_s` until `until_s` (s), in which a turtle had this pen."""

    from_s: float
    until_s: float
    pen: Pen


def pen_spans(recording: Recording, turtle: str = "turtle1") -> list[PenSpan]:
    """Return the pens of a turtle in order. The first pen is the pen with which turtlesim creates every turtle."""
    changes = [each for each in recording.pens if each.turtle == turtle]
    begins = [-math.inf, *(each.t_s for each in changes)]
    pens = [Pen(), *(Pen(each.color, each.width, each.down) for each in changes)]
    return [PenSpan(*span) for span in zip(begins, [*begins[1:], math.inf], pens, strict=True)]
