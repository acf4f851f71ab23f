"""Stage: what of a submission there is to judge."""

from __future__ import annotations

from typing import Literal

Stage = Literal["source", "build", "trial"]
"""What a check needs: the submission's files alone, what colcon made of them, or the recording of a trial."""

STAGES: tuple[Stage, ...] = ("source", "build", "trial")
"""In the order in which they are made."""
