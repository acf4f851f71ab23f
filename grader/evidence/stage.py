"""Stage: the part of the evidence that a check needs."""

from __future__ import annotations

from typing import Literal

Stage = Literal["source", "build", "trial"]
"""A check needs only the files of the submission, or the result of the build, or the result of a trial."""

STAGES: tuple[Stage, ...] = ("source", "build", "trial")
"""All stages, in order."""
