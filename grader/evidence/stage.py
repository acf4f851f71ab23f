"""Stage: which part of the evidence a check needs."""

from __future__ import annotations

from typing import Literal

Stage = Literal["source", "build", "trial"]
"""Only the files of the submission, the result of the build, or the recording of a trial."""

STAGES: tuple[Stage, ...] = ("source", "build", "trial")
"""All stages, in order."""
